#pragma once
// Windows: stretches of the record over which the model is integrated. They never cross a
// recording's edge or a gap.

#include <cstdint>
#include <span>
#include <vector>

#include "identify/recording/masked_recording.hpp"
#include "identify/recording/recording.hpp"

namespace jointid::identify {

/// How to cut. At most one of the two; neither: a duration chosen from the velocity's noise.
struct WindowOptions {
  std::int64_t count = 0;   ///< number of windows over the recording; 0: not given
  double duration = 0.0;    ///< length of a window [s]; 0: not given
  double factor = 1.0;      ///< multiplies the duration, however chosen
  bool cumulative = false;  ///< compare running integrals at the windows' ends, not each window's
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
  bool noise_limited = false;  ///< the windows used are too short for the noise
};

/// The shortest window over which the velocity changes by far more than its noise.
///
/// Too short, and noise at the edges attenuates the inertia; too long, and reversals blur. The
/// noise comes from the structure function D(L) = mean (v[k+L] - v[k])^2, which is noise plus a
/// term in L^2 for small L. The window is the shortest of at least 10 samples with noise / D <=
/// 0.001 that leaves at least 20 windows a parameter (on a record too short for that, at least 5
/// samples). A given duration is kept, and its noise is reported, too.
WindowChoice choose_window(const MaskedRecording& recording, std::int64_t parameters,
                           const WindowOptions& options = {});
WindowChoice choose_window(const RecordingView& recording, const std::vector<std::uint8_t>& usable,
                           std::int64_t parameters, const WindowOptions& options = {});

/// Equal windows over each gap-free stretch; those without a usable interval are left out.
std::vector<Window> cut_windows(const RecordingView& recording,
                                const std::vector<std::uint8_t>& usable, double duration);

/// How many windows each of these has before it in its stretch, those left out included. They were
/// cut with that duration.
std::vector<std::int64_t> places_of(const RecordingView& recording, std::span<const Window> windows,
                                    double duration);

/// The duration that gives about `count` windows over the gap-free stretches of all recordings.
double duration_for(const std::vector<RecordingView>& recordings, std::int64_t count);

}  // namespace jointid::identify
