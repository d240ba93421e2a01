#include "identify/recording/windows.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/input_error.hpp"

namespace jointid::identify {

namespace {

constexpr double kNoiseShare = 1e-3;
constexpr double kNoiseLimit = 1e-2;  // reduces the inertia by about this share
constexpr Eigen::Index kShortest =
    10;  // samples: in shorter windows, the model error next to a stop has too much weight
constexpr Eigen::Index kFewest =
    5;  // samples, if the recording is so short that 10 leave too few windows
constexpr std::int64_t kWindowsEach = 20;  // least number of windows per parameter

struct Stretch {
  std::int64_t begin;
  std::int64_t end;
};

std::vector<Stretch> stretches(const RecordingView& r) {
  std::vector<std::int64_t> gaps = r.gap_after;
  std::sort(gaps.begin(), gaps.end());
  std::vector<Stretch> result;
  std::int64_t begin = 0;
  for (const auto gap : gaps) {
    if (gap > begin) result.push_back({begin, gap});
    begin = gap + 1;
  }
  if (r.samples() - 1 > begin) result.push_back({begin, r.samples() - 1});
  return result;
}

double covered(const RecordingView& r) {
  double sum = 0.0;
  for (const auto& s : stretches(r)) sum += r.time[s.end] - r.time[s.begin];
  return sum;
}

/// Windows of this duration in a stretch.
std::int64_t count_in(const RecordingView& r, const Stretch& stretch, double duration) {
  const double length = r.time[stretch.end] - r.time[stretch.begin];
  const auto wanted = static_cast<std::int64_t>(std::llround(length / duration));
  return std::clamp<std::int64_t>(wanted, 1, stretch.end - stretch.begin);
}

}  // namespace

void WindowOptions::validate() const {
  if (count < 0) throw base::InputError("must be positive", "windows.count", base::as_value(count));
  if (!(duration >= 0.0) || !std::isfinite(duration)) {
    throw base::InputError("must be positive", "windows.duration", duration);
  }
  if (!(factor > 0.0) || !std::isfinite(factor)) {
    throw base::InputError("must be positive", "windows.factor", factor);
  }
  if (count > 0 && duration > 0.0)
    throw base::InputError("give count or duration, not both", "windows");
}

WindowChoice choose_window(const RecordingView& r, const std::vector<std::uint8_t>& usable,
                           std::int64_t parameters, const WindowOptions& options) {
  return choose_window(MaskedRecording(r, {usable, 0}), parameters, options);
}

WindowChoice choose_window(const MaskedRecording& r, std::int64_t parameters,
                           const WindowOptions& options) {
  const auto share = [&](Eigen::Index lag) {
    const double change = r.structure(lag);
    return change > 0.0 ? r.noise() / change : 1.0;
  };
  WindowChoice choice;
  choice.duration = options.duration;
  if (choice.duration == 0.0) {
    const Eigen::Index longest = std::max<Eigen::Index>(
        kFewest, r.usable_count() / std::max<std::int64_t>(1, kWindowsEach * parameters));
    Eigen::Index lag = std::min(kShortest, longest);
    while (share(lag) > kNoiseShare && lag < longest) lag = std::min(longest, lag + 1 + lag / 8);
    choice.duration = static_cast<double>(lag) * r.period();
  }
  choice.duration *= options.factor;
  // Noise share of these windows, with a chosen or a fixed duration.
  const double lag = std::round(choice.duration / r.period());
  choice.noise_share = share(static_cast<Eigen::Index>(
      std::clamp(lag, 1.0, static_cast<double>(r.recording().samples() - 1))));
  choice.noise_limited = choice.noise_share > kNoiseLimit;
  return choice;
}

std::vector<Window> cut_windows(const RecordingView& r, const std::vector<std::uint8_t>& usable,
                                double duration) {
  if (!(duration > 0.0)) throw std::invalid_argument("windows: duration must be positive");
  std::vector<Window> windows;
  for (const auto& stretch : stretches(r)) {
    const auto intervals = stretch.end - stretch.begin;
    const auto count = count_in(r, stretch, duration);
    windows.reserve(windows.size() + static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) {
      const Window window{stretch.begin + intervals * i / count,
                          stretch.begin + intervals * (i + 1) / count};
      if (std::any_of(usable.begin() + window.begin, usable.begin() + window.end,
                      [](std::uint8_t flag) { return flag != 0; })) {
        windows.push_back(window);
      }
    }
  }
  return windows;
}

std::vector<std::int64_t> places_of(const RecordingView& r, std::span<const Window> windows,
                                    double duration) {
  std::vector<std::int64_t> places;
  places.reserve(windows.size());
  auto window = windows.begin();
  for (const auto& stretch : stretches(r)) {
    const auto intervals = stretch.end - stretch.begin;
    const auto count = count_in(r, stretch, duration);
    for (; window != windows.end() && window->end <= stretch.end; ++window) {
      // The index of the window that begins there: begin = intervals place / count, rounded down.
      const auto begin = window->begin - stretch.begin;
      places.push_back((begin * count + intervals - 1) / intervals);
    }
  }
  return places;
}

double duration_for(const std::vector<RecordingView>& recordings, std::int64_t count) {
  std::int64_t intervals = 0;
  double time = 0.0;
  for (const auto& recording : recordings) {
    intervals += recording.samples() - 1;
    time += covered(recording);
  }
  if (count > intervals) {
    throw base::InputError(std::to_string(count) + " windows need more than the recording's " +
                               std::to_string(intervals) + " sample intervals",
                           "windows");
  }
  return time / static_cast<double>(count);
}

}  // namespace jointid::identify
