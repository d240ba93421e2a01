#include "identify/penalty/penalty_parts.hpp"

#include <utility>

namespace jointid::identify {

namespace {

constexpr std::int64_t kSamples =
    8192;  // samples per part: its columns and nodes stay in the cache

}  // namespace

PenaltyParts::PenaltyParts(const Penalty::Masked& recordings, const std::vector<std::string>& terms,
                           const WindowOptions& windows, Residual residual, double gear_ratio,
                           const std::vector<std::string>& per_recording)
    : recordings_(recordings),
      gear_ratio_(gear_ratio),
      per_recording_(per_recording),
      frame_(recordings, terms, residual, gear_ratio) {
  windows.validate();
  frame_.cumulative_ = windows.cumulative;
  frame_.cut(recordings, windows);
  windows_.swap(frame_.windows_);
  recording_of_.swap(frame_.recording_of_);
  divide({});
}

PenaltyParts::PenaltyParts(const Penalty::Masked& recordings, const std::vector<std::string>& terms,
                           CutWindows windows, const std::vector<std::size_t>& ends,
                           Residual residual, double gear_ratio,
                           const std::vector<std::string>& per_recording)
    : recordings_(recordings),
      gear_ratio_(gear_ratio),
      per_recording_(per_recording),
      frame_(recordings, terms, residual, gear_ratio),
      windows_(std::move(windows.windows)),
      recording_of_(std::move(windows.recording_of)) {
  divide(ends);
}

void PenaltyParts::divide(const std::vector<std::size_t>& ends) {
  first_.push_back(0);
  std::int64_t held = 0;
  auto end = ends.begin();
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    while (end != ends.end() && *end < w) ++end;
    const bool whole = ends.empty() || (end != ends.end() && *end == w);
    if (held >= kSamples && whole && !frame_.cumulative_) {
      first_.push_back(w);
      held = 0;
    }
    held += windows_[w].end - windows_[w].begin;
  }
  first_.push_back(windows_.size());
  Penalty whole = frame_;
  whole.columns_.setZero(0, static_cast<Eigen::Index>(whole.terms_.size()));
  whole.backward_.setZero(0, whole.columns_.cols());
  whole.own_columns(per_recording_, recordings_.size());
  names_ = whole.parameters();
  coefficients_ = whole.coefficients();
  if (frame_.residual() == Residual::sensor) divisor_ = whole.gain_index();
}

Penalty PenaltyParts::part(std::size_t index) const {
  Penalty result = frame_;
  const auto from = static_cast<std::ptrdiff_t>(first_[index]);
  const auto to = static_cast<std::ptrdiff_t>(first_[index + 1]);
  result.windows_.assign(windows_.begin() + from, windows_.begin() + to);
  result.recording_of_.assign(recording_of_.begin() + from, recording_of_.begin() + to);
  result.integrate_all(recordings_, gear_ratio_, nullptr);
  result.own_columns(per_recording_, recordings_.size());
  result.weigh_link();
  result.accumulate_all();
  return result;
}

std::optional<FirstStage> PenaltyParts::first_stage(
    const std::vector<Eigen::Index>& free, const std::vector<std::unique_ptr<Penalty>>& made,
    base::Pool* pool) const {
  if (frame_.residual() != Residual::instruments) return std::nullopt;
  const Instruments instruments = made.empty() ? part(0).instruments(free, windows_.size())
                                               : made[0]->instruments(free, windows_.size());
  std::vector<Eigen::MatrixXd> triangles(count());
  for_each(count(), pool, [&](std::size_t i) {
    triangles[i] = made.empty() ? part(i).instrument_triangle(instruments, nullptr)
                                : made[i]->instrument_triangle(instruments, nullptr);
  });
  return solve_first_stage(instruments, fold(triangles), window_count());
}

void for_each(std::size_t count, base::Pool* pool, const std::function<void(std::size_t)>& work) {
  if (pool == nullptr) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  pool->for_each(count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      pool->cancel().check();
      work(i);
    }
  });
}

}  // namespace jointid::identify
