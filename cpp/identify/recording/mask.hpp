#pragma once
// The mask: the usable sample intervals of a recording.

#include <cstdint>
#include <vector>

#include "base/cancel.hpp"
#include "identify/recording/recording.hpp"

namespace jointid::identify {

/// Scale of a motion, with which the mask compares speeds. A fragment uses the scale of the whole
/// motion.
struct MotionScale {
  double peak = 0.0;     ///< largest speed
  double travel = 0.0;   ///< distance from the lowest position to the highest
  double period = 0.0;   ///< period of the motion, estimated [s]
  double quantum = 0.0;  ///< smallest change of position between samples; infinite if there is none
  double finest = 0.0;   ///< smallest speed above 0; infinite if there is none
  double push = 0.0;     ///< largest torque

  [[nodiscard]] bool moves() const { return peak > 0.0 && travel > 0.0; }
  /// Time at rest that distinguishes a standing joint from a slow one [s].
  [[nodiscard]] double memory() const;
};
MotionScale motion_scale(const RecordingView& recording);

/// One flag per sample interval k -> k+1: 1 where the joint moves and the recording has no gap.
///
/// Left out are:
/// - gaps;
/// - runs in which the joint really sticks (position unchanged, or velocity exactly zero, for
/// longer than the resolution explains), with two intervals on either side, because friction is
/// set-valued there and the model gives no value;
/// - stops shorter than a sample interval, with the same margin; only a fine velocity shows them;
/// - standing still: below 0.3 % of the peak speed for 0.1 s or longer, in slow motion for 1 % of
/// its period;
/// - two intervals on either side of a reversal at which a held command jumps by 5 % of the largest
/// torque, as in friction compensation by the sign of a velocity: the time of the reversal within
/// the interval is unknown;
/// - with a least speed, every interval that begins or ends below it;
/// - intervals that the recording marks as doubtful, because a sample was late or a command
/// unknown.
/// Other reversals are kept, because dropping all slow samples biases viscous friction.
struct UsableIntervals {
  std::vector<std::uint8_t> usable;
  std::int64_t standing = 0;  ///< samples that stick or stand still
};
UsableIntervals usable_intervals(const RecordingView& recording, bool mask_standstill,
                                 const base::Cancel* cancel = nullptr);
/// The same for a fragment. If the joint stands still throughout, nothing is usable.
UsableIntervals usable_intervals(const RecordingView& recording, const MotionScale& scale,
                                 bool mask_standstill, const base::Cancel* cancel = nullptr);

}  // namespace jointid::identify
