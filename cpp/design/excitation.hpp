#pragma once
// Value of a motion: the errors that an identification from it would have. It is computed for
// several joints that the prior allows, each moved by the controller that will drive it.

#include <Eigen/Core>
#include <vector>

#include "base/pool.hpp"
#include "design/candidate.hpp"
#include "design/information.hpp"
#include "search/population.hpp"
#include "simulate/simulator.hpp"

namespace jointid::design {

enum class Criterion { worst, determinant };

/// One joint that the prior allows.
struct Drawn {
  simulate::Setup setup{};
  std::vector<Column> columns{};  ///< columns of the free parameters, the same for all joints
  Noise noise{};
  Eigen::VectorXd scale;   ///< unit in which an error counts
  Eigen::VectorXd weight;  ///< 1: requested, 0: not
  Eigen::MatrixXd known;   ///< existing information: other recordings and the prior
  double inertia = 0.0;    ///< inertia that multiplies a window's change of velocity
  double viscous = 0.0;
};

/// Limits of the joints themselves.
struct Held {
  double lowest = -1e300;
  double highest = 1e300;
  double velocity = 1e300;
  double acceleration = 1e300;
  double torque = 1e300;
  double link_torque = 1e300;

  void validate() const;
};

/// Judgement of one motion for one joint.
struct Judgement {
  Eigen::VectorXd errors;  ///< expected root-mean-square errors over their scales
  Eigen::VectorXd bias;    ///< the part of them that is the same in every recording of the motion
  Eigen::MatrixXd information;
  double lowest = 0.0;  ///< lowest position that the joint reaches
  double highest = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;
  double torque = 0.0;
  double link_torque = 0.0;
  double excess = 0.0;  ///< the largest excess over a limit, as a share of it; 0: none
};

class Excitation {
 public:
  Excitation(Family family, simulate::Scenario scenario, std::vector<Drawn> joints, Held held,
             Criterion criterion, int window);

  [[nodiscard]] const Family& family() const { return family_; }
  /// One judgement per joint.
  [[nodiscard]] std::vector<Judgement> judge(const simulate::Trajectory& trajectory,
                                             const base::Cancel& cancel) const;
  /// The logarithm of the criterion, increased where a limit is exceeded.
  [[nodiscard]] double cost(const std::vector<Judgement>& judgements) const;
  /// Costs of candidates' genes, one candidate per column. Positive, as the search needs.
  void evaluate(const Eigen::MatrixXd& candidates, Eigen::VectorXd& costs, base::Pool& pool) const;
  /// Leaves out, for each joint, the parameters that none of these motions determines to within
  /// `largest`.
  void leave_out(const Eigen::MatrixXd& candidates, double largest, base::Pool& pool);
  [[nodiscard]] const std::vector<Drawn>& joints() const { return joints_; }

 private:
  [[nodiscard]] Judgement judged(const Drawn& joint, const simulate::Signals& signals) const;

  Family family_;
  simulate::Scenario scenario_;
  std::vector<Drawn> joints_;
  Held held_;
  Criterion criterion_;
  int window_;
};

}  // namespace jointid::design

template <>
struct jointid::base::Words<jointid::design::Criterion> {
  static constexpr std::string_view field = "criterion";
  static constexpr std::array<std::string_view, 2> all{"worst", "determinant"};
};
