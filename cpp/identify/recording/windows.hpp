#pragma once
// Windows: stretches of the recording over which the model is integrated. They never cross a
// recording's edge or a gap.

#include <cstdint>
#include <span>
#include <vector>

#include "identify/recording/masked_recording.hpp"
#include "identify/recording/recording.hpp"

namespace jointid::identify {

/// How to cut. Set at most one of count and duration. With neither, the velocity's noise decides
/// the duration.
struct WindowOptions {
  std::int64_t count = 0;  ///< number of windows over the recording; 0: not set
  double duration = 0.0;   ///< length of a window [s]; 0: not set
  double factor = 1.0;     ///< factor on the duration, however it was chosen
  bool cumulative =
      false;  ///< compare running integrals at the windows' ends instead of each window's integral
  void validate() const;
};

/// Sample intervals [begin, end): from sample begin to sample end.
struct Window {
  std::int64_t begin;
  std::int64_t end;
};

struct WindowChoice {
  double duration = 0.0;  ///< [s]
  double noise_share =
      0.0;  ///< variance of the velocity noise at the edges over that of the velocity change
  bool noise_limited = false;  ///< the windows are too short for the noise
};

/// The shortest window over which the velocity changes by much more than its noise.
///
/// In shorter windows, noise at the edges reduces the inertia; longer windows blur reversals. The
/// noise comes from the structure function D(L) = mean (v[k+L] - v[k])^2, which is noise plus a
/// term in L^2 for small L. The window is the shortest with at least 10 samples and noise / D <=
/// 0.001 that leaves at least 20 windows per parameter (on a recording too short for that, at least
/// 5 samples). A fixed duration is kept, and its noise is reported, too.
WindowChoice choose_window(const MaskedRecording& recording, std::int64_t parameters,
                           const WindowOptions& options = {});
WindowChoice choose_window(const RecordingView& recording, const std::vector<std::uint8_t>& usable,
                           std::int64_t parameters, const WindowOptions& options = {});

/// Equal windows over each gap-free stretch. Windows without a usable interval are left out.
std::vector<Window> cut_windows(const RecordingView& recording,
                                const std::vector<std::uint8_t>& usable, double duration);

/// Number of windows before each of these in its stretch, including those left out. `duration` is
/// their duration.
std::vector<std::int64_t> places_of(const RecordingView& recording, std::span<const Window> windows,
                                    double duration);

/// The duration that gives about `count` windows over the gap-free stretches of all recordings.
double duration_for(const std::vector<RecordingView>& recordings, std::int64_t count);

}  // namespace jointid::identify
