#include "identify/penalty/penalty.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "base/input_error.hpp"
#include "base/ranks.hpp"

namespace jointid::identify {

void Penalty::add_term(const std::string& key) {
  const Term term = find_term(key);
  const auto coefficients = static_cast<std::ptrdiff_t>(terms_.size());
  if (needs_load(term)) {  // it acts on the sum of the other terms
    load_ = static_cast<Eigen::Index>(names_.size() - terms_.size());
    link_load_ = term.integral == Integral::link_friction;
    names_.push_back(term.name);
    return;
  }
  const auto begin = names_.begin();
  if (std::find(begin, begin + coefficients, term.name) != begin + coefficients) {
    throw std::invalid_argument("term '" + term.name + "' is listed twice");
  }
  names_.insert(begin + coefficients, term.name);
  if (term.integral == Integral::sensor) gain_index_ = coefficients;
  if (!term.shapes.empty()) {
    Shaped shaped{coefficients, {}, term};
    for (const auto& shape : term.shapes) {
      const auto first = names_.begin() + coefficients + 1;
      const auto found = std::find(first, names_.end(), shape);
      shaped.shapes.push_back(found - first);
      if (found == names_.end()) names_.push_back(shape);
    }
    shaped_.push_back(std::move(shaped));
  }
  terms_.push_back(term);
}

namespace {

/// Usable intervals in which the net motion is backward.
std::vector<std::uint8_t> backward_intervals(const RecordingView& r,
                                             const std::vector<std::uint8_t>& usable) {
  std::vector<std::uint8_t> result(usable.size());
  for (std::size_t k = 0; k < usable.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    result[k] = usable[k] != 0 && r.velocity[i] + r.velocity[i + 1] < 0.0 ? 1 : 0;
  }
  return result;
}

std::vector<std::shared_ptr<const MaskedRecording>> masked(const std::vector<Recording>& recordings,
                                                           bool mask_standstill) {
  std::vector<std::shared_ptr<const MaskedRecording>> result;
  for (const auto& recording : recordings) {
    recording.validate();
    result.push_back(std::make_shared<const MaskedRecording>(
        recording, usable_intervals(recording, mask_standstill)));
  }
  return result;
}

}  // namespace

Penalty::Penalty(std::vector<Recording> recordings, const std::vector<std::string>& terms,
                 const WindowOptions& options, Residual residual, bool mask_standstill,
                 double gear_ratio, const std::vector<std::string>& per_recording)
    : Penalty(masked(recordings, mask_standstill), terms, options, residual, gear_ratio,
              per_recording) {}

Penalty::Penalty(const Masked& recordings, const std::vector<std::string>& terms, Residual residual,
                 double gear_ratio)
    : residual_(residual) {
  if (recordings.empty()) throw std::invalid_argument("a penalty needs at least one recording");
  if (terms.empty()) throw std::invalid_argument("a penalty needs at least one term");
  if (!std::isfinite(gear_ratio) || gear_ratio == 0.0) {
    throw std::invalid_argument("gear_ratio must be finite and not 0");
  }
  for (const auto& key : terms) add_term(key);
  if (link_load_ && gain_index_ < 0) {  // nothing separates the link's inertia from the drive's
    share_ = static_cast<Eigen::Index>(names_.size() - terms_.size());
    names_.emplace_back("link_share");
  }
  if (residual != Residual::torque && gain_index_ < 0) {
    throw std::invalid_argument(std::string("residual '") +
                                (residual == Residual::sensor ? "sensor" : "instruments") +
                                "' needs the term sensor_gain");
  }
  runs_ = static_cast<Eigen::Index>(recordings.size());
  for (const auto& recording : recordings) {
    if (gain_index_ >= 0 && !recording->recording().has_sensor()) {
      throw std::invalid_argument("the term sensor_gain needs a recording with a sensor signal");
    }
    if (residual == Residual::instruments && recording->recording().samples() > 0) {
      fastest_ = std::max(fastest_, recording->recording().velocity.cwiseAbs().maxCoeff());
    }
    standing_ += recording->standing();
    total_ += recording->recording().samples();
    unusable_ += recording->unusable_count();
  }
}

Penalty::Penalty(const Masked& recordings, const std::vector<std::string>& terms,
                 const WindowOptions& options, Residual residual, double gear_ratio,
                 const std::vector<std::string>& per_recording, base::Pool* pool)
    : Penalty(recordings, terms, residual, gear_ratio) {
  options.validate();
  cumulative_ = options.cumulative;
  cut(recordings, options);
  integrate_all(recordings, gear_ratio, pool);
  own_columns(per_recording, recordings.size());
  weigh_link();
  accumulate_all();
}

void Penalty::accumulate_all() {
  if (!cumulative_) return;
  accumulate(target_);
  if (load_ >= 0) return;  // there the residuals of the sum are accumulated
  for (Eigen::Index j = 0; j < columns_.cols(); ++j) accumulate(columns_.col(j));
  for (Eigen::Index j = 0; j < link_.cols(); ++j) accumulate(link_.col(j));
}

void Penalty::cut(const Masked& recordings, WindowOptions wanted) {
  if (wanted.count > 0) {
    std::vector<RecordingView> views;
    for (const auto& recording : recordings) views.push_back(recording->recording());
    wanted.duration = duration_for(views, wanted.count);
  }
  std::vector<double> lengths;
  const auto given =
      std::count_if(terms_.begin(), terms_.end(), [](const Term& t) { return t.given; });
  const std::int64_t unknown = std::max<std::int64_t>(1, parameters() - given);
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const auto& time = recordings[i]->recording().time;
    // Each recording by its own noise and rate: a coarse one must not lengthen the windows of a
    // fine one.
    const auto choice = choose_window(*recordings[i], unknown, wanted);
    const double length = time[time.size() - 1] - time[0];
    if (choice.duration > length) {
      throw base::InputError("duration " + std::to_string(choice.duration) +
                                 " s is longer than the recording, " + std::to_string(length) +
                                 " s",
                             "windows");
    }
    choice_.noise_share = std::max(choice_.noise_share, choice.noise_share);
    choice_.noise_limited = choice_.noise_limited || choice.noise_limited;
    cut_durations_.push_back(choice.duration);
    auto windows =
        cut_windows(recordings[i]->recording(), recordings[i]->usable(), choice.duration);
    recording_of_.insert(recording_of_.end(), windows.size(), static_cast<int>(i));
    lengths.reserve(lengths.size() + windows.size());
    for (const auto& window : windows) lengths.push_back(time[window.end] - time[window.begin]);
    if (windows_.empty()) {
      windows_.swap(windows);
    } else {
      // One by one, because gcc 14 wrongly warns that insert() writes beyond the end.
      for (const auto& window : windows) windows_.push_back(window);
    }
  }
  if (!lengths.empty()) {
    choice_.duration = base::at_rank(lengths.data(), lengths.size(), lengths.size() / 2).value;
  }
  const auto rows = static_cast<Eigen::Index>(windows_.size());
  if (rows == 0) {
    throw base::InputError("the joint stands still or sticks throughout: record motion");
  }
  if (rows < unknown) {
    throw base::InputError(std::to_string(rows) + " windows with motion cannot determine " +
                               std::to_string(unknown) + " parameters; use more or shorter windows",
                           "windows");
  }
}

void Penalty::integrate_all(const Masked& recordings, double gear_ratio, base::Pool* pool) {
  const auto rows = static_cast<Eigen::Index>(windows_.size());
  columns_.resize(rows, static_cast<Eigen::Index>(terms_.size()));
  for (const auto& shaped : shaped_) columns_.col(shaped.coefficient).setZero();
  target_.resize(rows);
  usable_duration_.resize(rows);
  std::vector<std::vector<std::uint8_t>> backward;
  if (load_ >= 0) {
    backward_.setZero(rows, columns_.cols());
    for (const auto& masked : recordings) {
      backward.push_back(backward_intervals(masked->recording(), masked->usable()));
    }
  }
  if (residual_ == Residual::instruments && !shaped_.empty()) {
    decays_.clear();
    for (const auto& recording : recordings) {
      decays_.push_back(recording->decays(instrument_rates(fastest_)));
    }
  }
  struct Block {  // windows of one recording
    std::size_t begin;
    std::size_t end;
  };
  constexpr std::size_t kWindows = 4096;
  std::vector<Block> blocks;
  for (std::size_t w = 0; w < windows_.size();) {
    std::size_t end = w;
    while (end < windows_.size() && end - w < kWindows && recording_of_[end] == recording_of_[w])
      ++end;
    blocks.push_back({w, end});
    w = end;
  }
  const Term duration = find_term("torque_offset");
  link_.resize(residual_ == Residual::instruments ? rows : 0, Instruments::kLink);
  const base::Cancel* cancel = pool != nullptr ? &pool->cancel() : nullptr;
  const auto linear = [&](const Block& block) {
    if (cancel != nullptr) cancel->check();
    const auto& masked = *recordings[static_cast<std::size_t>(recording_of_[block.begin])];
    const auto& r = masked.recording();
    const auto windows = std::span(windows_).subspan(block.begin, block.end - block.begin);
    const auto first = static_cast<Eigen::Index>(block.begin);
    const auto count = static_cast<Eigen::Index>(windows.size());
    integrate_torque(r, masked.usable(), windows, target_.segment(first, count));
    integrate(duration, gear_ratio, r, masked.usable(), windows,
              usable_duration_.segment(first, count));
    for (std::size_t j = 0; j < terms_.size(); ++j) {
      if (!terms_[j].shapes.empty()) continue;
      integrate(terms_[j], gear_ratio, r, masked.usable(), windows,
                columns_.col(static_cast<Eigen::Index>(j)).segment(first, count));
    }
    if (residual_ == Residual::instruments) integrate_link(r, first, count);
    if (load_ < 0) return;
    const auto& usable = backward[static_cast<std::size_t>(recording_of_[block.begin])];
    for (std::size_t j = 0; j < terms_.size(); ++j) {
      if (!terms_[j].shapes.empty()) continue;
      integrate(terms_[j], gear_ratio, r, usable, windows,
                backward_.col(static_cast<Eigen::Index>(j)).segment(first, count));
    }
  };
  if (pool == nullptr) {
    for (const auto& block : blocks) linear(block);
    collect_nodes(recordings, cancel, false);
    if (load_ >= 0) collect_nodes(recordings, cancel, true);
  } else {  // the nodes are the longest task, so they go first
    pool->for_each(blocks.size() + 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (i == 0) {
          collect_nodes(recordings, cancel, false);
          if (load_ >= 0) collect_nodes(recordings, cancel, true);
        } else {
          linear(blocks[i - 1]);
        }
      }
    });
  }
}

void Penalty::collect_nodes(const Masked& recordings, const base::Cancel* cancel, bool backward) {
  if (shaped_.empty()) return;
  auto& store = backward ? backward_nodes_ : nodes_;
  auto& all = store[0];
  std::size_t samples = windows_.size();
  for (const auto& window : windows_)
    samples += static_cast<std::size_t>(window.end - window.begin);
  all.speed.reserve(samples + samples / 64 + 64);
  all.weight.reserve(samples + samples / 64 + 64);
  all.first.reserve(windows_.size() + 1);
  constexpr std::size_t kWindows = 4096;  // windows between two checks of the cancel flag
  for (std::size_t w = 0; w < windows_.size();) {
    if (cancel != nullptr) cancel->check();
    std::size_t end = w;
    while (end < windows_.size() && end - w < kWindows && recording_of_[end] == recording_of_[w])
      ++end;
    const auto& masked = *recordings[static_cast<std::size_t>(recording_of_[w])];
    const auto& r = masked.recording();
    const auto own = std::span(windows_).subspan(w, end - w);
    if (backward) {
      append_nodes(r, backward_intervals(r, masked.usable()), own, all);
    } else {  // by reference: a conditional expression would copy it for every part of a recording
      append_nodes(r, masked.usable(), own, all);
    }
    w = end;
  }
  const bool general = std::any_of(shaped_.begin(), shaped_.end(), [](const Shaped& shaped) {
    return shaped.term.basis == model::SpeedBasis::general;
  });
  if (general) all.take_logarithms();
  bool both = false;
  for (const auto& shaped : shaped_) {
    auto& nodes = store[static_cast<std::size_t>(shaped.term.direction)];
    if (nodes.first.size() == 1) nodes = nodes_of(shaped.term.direction, store[0]);
    both = both || shaped.term.direction == model::Direction::both;
  }
  if (!both) store[0] = {};
}

Penalty Penalty::fragment(const Masked& recordings, const std::vector<std::string>& terms,
                          double window_duration, Residual residual, double gear_ratio) {
  Penalty result(recordings, terms, residual, gear_ratio);
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const auto windows =
        cut_windows(recordings[i]->recording(), recordings[i]->usable(), window_duration);
    result.windows_.insert(result.windows_.end(), windows.begin(), windows.end());
    result.recording_of_.insert(result.recording_of_.end(), windows.size(), static_cast<int>(i));
  }
  result.choice_.duration = window_duration;
  result.integrate_all(recordings, gear_ratio, nullptr);
  result.weigh_link();
  return result;
}

double Penalty::peak_speed() const {
  double speed = 0.0;
  for (const auto& shaped : shaped_) {
    for (const double v : nodes(shaped.term.direction).speed) speed = std::max(speed, v);
  }
  return speed;
}

bool Penalty::is_shaped(Eigen::Index coefficient) const {
  return std::any_of(shaped_.begin(), shaped_.end(),
                     [&](const Shaped& shaped) { return shaped.coefficient == coefficient; });
}

void Penalty::accumulate(Eigen::Ref<Eigen::VectorXd> values) const {
  for (Eigen::Index row = 1; row < values.size(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    if (recording_of_[r] == recording_of_[r - 1]) values[row] += values[row - 1];
  }
}

}  // namespace jointid::identify
