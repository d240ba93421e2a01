#include "design/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/decompositions.hpp"
#include "base/elementary.hpp"

namespace jointid::design {

namespace {

constexpr double kExcess = 20.0;    // added to the logarithm per unit of a limit
constexpr double kUnknown = 1e6;    // of an error: the parameter is not determined
constexpr double kWeakest = 1e-13;  // least eigenvalue of a correlation matrix
constexpr double kUnstable = 1e3;   // a loop that diverges: worse than any other

double beyond(double reached, double allowed) {
  return allowed < 1e300 ? reached / allowed - 1.0 : 0.0;
}

void hold(Judgement& j, const Held& held) {
  const double range = held.highest - held.lowest;
  j.excess = std::max({0.0, (j.highest - held.highest) / range, (held.lowest - j.lowest) / range,
                       beyond(j.velocity, held.velocity), beyond(j.acceleration, held.acceleration),
                       beyond(j.torque, held.torque), beyond(j.link_torque, held.link_torque)});
}

/// Root-mean-square errors from an information matrix and the systematic error, and the bias in
/// them. kUnknown for a parameter without information.
std::pair<Eigen::VectorXd, Eigen::VectorXd> errors_of(const Eigen::MatrixXd& information,
                                                      const Eigen::VectorXd& misled) {
  const Eigen::VectorXd told = information.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd size = (told.array() > 0.0).select(told, 1.0);
  const Eigen::MatrixXd correlation =
      size.cwiseInverse().asDiagonal() * information * size.cwiseInverse().asDiagonal();
  const auto [values, directions] = base::eigenpairs(correlation);
  const Eigen::VectorXd strength = values.cwiseMax(kWeakest);
  const Eigen::VectorXd along =
      (directions.transpose() * misled.cwiseQuotient(size)).cwiseQuotient(strength);
  const Eigen::VectorXd bias = (directions * along).cwiseQuotient(size);
  const Eigen::VectorXd scatter =
      (directions.cwiseAbs2() * strength.cwiseInverse()).cwiseQuotient(size.cwiseAbs2());
  Eigen::VectorXd errors = (scatter + bias.cwiseAbs2()).cwiseSqrt();
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    if (!(told[i] > 0.0) || !(errors[i] < kUnknown)) errors[i] = kUnknown;
  }
  return {errors, bias};
}

}  // namespace

void Held::validate() const {
  const base::Requirement require("HeldLimits");
  require.that(highest > lowest, "highest", highest, "above the lowest");
  require.that(velocity > 0.0, "velocity", velocity, "above 0");
  require.that(acceleration > 0.0, "acceleration", acceleration, "above 0");
  require.that(torque > 0.0, "torque", torque, "above 0");
  require.that(link_torque > 0.0, "link_torque", link_torque, "above 0");
}

Excitation::Excitation(Family family, simulate::Scenario scenario, std::vector<Drawn> joints,
                       Held held, Criterion criterion, int window)
    : family_(family),
      scenario_(scenario),
      joints_(std::move(joints)),
      held_(held),
      criterion_(criterion),
      window_(window) {
  family_.validate();
  scenario_.validate();
  const base::Requirement require("design");
  require.that(!joints_.empty(), "joints", 0.0, "at least one");
  require.that(window_ >= 1, "window", window_, "at least one sample");
  for (const auto& joint : joints_) joint.setup.validate();
}

std::vector<Judgement> Excitation::judge(const simulate::Trajectory& trajectory,
                                         const base::Cancel& cancel) const {
  // Kept between motions, because allocating memory would cost as much as the simulation.
  thread_local std::vector<simulate::Reference> wanted;
  thread_local std::vector<simulate::Outcome> outcomes;
  wanted.resize(scenario_.instants());
  trajectory.sample(scenario_.control_period, wanted);
  std::vector<Judgement> result;
  result.reserve(joints_.size());
  // No more at a time than can run in parallel, because the signals of many joints would fill the
  // memory.
  for (std::size_t first = 0; first < joints_.size(); first += simulate::kSideBySide) {
    const std::size_t last = std::min(joints_.size(), first + simulate::kSideBySide);
    std::vector<simulate::Setup> setups;
    for (std::size_t i = first; i < last; ++i) {
      setups.push_back(joints_[i].setup);
      setups.back().position = wanted.front().position;
    }
    outcomes.resize(setups.size());
    simulate::simulate_on_this_thread(scenario_, wanted, setups, outcomes, simulate::Kept::truth,
                                      cancel);
    for (std::size_t i = first; i < last; ++i) {
      result.push_back(judged(joints_[i], outcomes[i - first].signals));
    }
  }
  return result;
}

Judgement Excitation::judged(const Drawn& joint, const simulate::Signals& s) const {
  Judgement j;
  const auto [low, high] = std::minmax_element(s.true_position.begin(), s.true_position.end());
  const auto magnitude = [](const std::vector<double>& values) {
    double most = 0.0;
    for (const double value : values) most = std::max(most, std::fabs(value));
    return most;
  };
  j.lowest = *low;
  j.highest = *high;
  j.velocity = magnitude(s.true_velocity);
  j.acceleration = magnitude(s.true_acceleration);
  j.torque = magnitude(s.torque);
  j.link_torque = magnitude(s.link_torque);
  hold(j, held_);
  const double period = scenario_.control_period * scenario_.sample_every;
  const Told told = information(s, joint.columns, joint.noise, joint.setup.joint, joint.inertia,
                                joint.viscous, period, window_);
  j.information = told.information;
  Eigen::MatrixXd scaled = told.information + joint.known;
  scaled = (joint.scale.asDiagonal() * scaled * joint.scale.asDiagonal()).eval();
  std::tie(j.errors, j.bias) = errors_of(scaled, joint.scale.cwiseProduct(told.misled));
  return j;
}

double Excitation::cost(const std::vector<Judgement>& judgements) const {
  double sum = 0.0;
  double counted = 0.0;
  double excess = 0.0;
  for (std::size_t i = 0; i < judgements.size(); ++i) {
    const auto& errors = judgements[i].errors;
    const auto& weight = joints_[i].weight;
    excess = std::max(excess, judgements[i].excess);
    double worst = 0.0;
    double logarithms = 0.0;
    double asked = 0.0;
    for (Eigen::Index p = 0; p < errors.size(); ++p) {
      if (weight[p] <= 0.0) continue;
      const double error = std::clamp(weight[p] * errors[p], 1e-12, 1e6);
      worst = std::max(worst, error);
      logarithms += base::log(error);
      asked += 1.0;
    }
    if (asked == 0.0) continue;
    sum += criterion_ == Criterion::worst ? base::log(worst) : logarithms / asked;
    counted += 1.0;
  }
  return (counted > 0.0 ? sum / counted : 0.0) + kExcess * excess;
}

void Excitation::evaluate(const Eigen::MatrixXd& candidates, Eigen::VectorXd& costs,
                          base::Pool& pool) const {
  costs.resize(candidates.cols());
  pool.for_each(
      static_cast<std::size_t>(candidates.cols()),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const auto column = static_cast<Eigen::Index>(i);
          const Sines sines = motion_of(family_, candidates.col(column));
          double found = kUnstable;
          try {
            found = cost(judge(sines.trajectory(), pool.cancel()));
          } catch (const base::InputError&) {
            found = kUnstable;  // a loop that is not stable along this motion
          }
          costs[column] = base::exp(std::clamp(found, -kUnstable, 0.5 * kUnstable));
        }
      },
      1);
}

void Excitation::leave_out(const Eigen::MatrixXd& candidates, double largest, base::Pool& pool) {
  const auto count = static_cast<std::size_t>(candidates.cols());
  std::vector<std::vector<Judgement>> all(count);
  pool.for_each(
      count,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const Sines sines = motion_of(family_, candidates.col(static_cast<Eigen::Index>(i)));
          try {
            all[i] = judge(sines.trajectory(), pool.cancel());
          } catch (const base::InputError&) {
            all[i].clear();
          }
        }
      },
      1);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    Eigen::VectorXd best = Eigen::VectorXd::Constant(joints_[j].scale.size(), 1e6);
    for (const auto& one : all) {
      if (!one.empty()) best = best.cwiseMin(one[j].errors);
    }
    for (Eigen::Index p = 0; p < best.size(); ++p) {
      if (best[p] > largest) joints_[j].weight[p] = 0.0;
    }
  }
}

}  // namespace jointid::design
