#pragma once
// The mask: which sample intervals of a recording may be used.

#include <cstdint>
#include <vector>

#include "base/cancel.hpp"
#include "identify/recording/recording.hpp"

namespace jointid::identify {

/// Scale of a motion, which the mask compares speeds with: that of the whole motion, also for a
/// fragment of it.
struct MotionScale {
  double peak = 0.0;     ///< largest speed
  double travel = 0.0;   ///< from the lowest position to the highest
  double period = 0.0;   ///< of the motion, estimated [s]
  double quantum = 0.0;  ///< smallest change of position between samples; infinite without one
  double finest = 0.0;   ///< smallest speed but 0; infinite without one
  double push = 0.0;     ///< largest torque

  [[nodiscard]] bool moves() const { return peak > 0.0 && travel > 0.0; }
  /// Time at rest that distinguishes a standing joint from a slow one [s].
  [[nodiscard]] double memory() const;
};
MotionScale motion_scale(const RecordingView& recording);

/// One flag per sample interval k -> k+1: 1 where the joint moves and the record has no gap.
///
/// Left out are, narrowly: gaps; runs in which the joint truly sticks (position unchanged, or
/// velocity exactly zero, for longer than the resolution explains) with two intervals either side,
/// where friction is set-valued and the model gives no value; stops that are shorter than a sample
/// interval, which only a fine velocity shows, in the same way; and standing still (creeping below
/// 0.3 % of the peak speed for 0.1 s or longer; at slow motion 1 % of its period). A reversal alone
/// is kept: dropping all slow samples biases viscous friction. But where a held command jumps by 5
/// % of the largest torque at a reversal, as when friction is compensated by the sign of a
/// velocity, two intervals either side are left out: the instant of the reversal within the
/// interval is unknown. With a least speed also every interval that begins or ends below it, and
/// always those that the recording itself calls doubtful: a sample was late, or a command unseen.
struct UsableIntervals {
  std::vector<std::uint8_t> usable;
  std::int64_t standing = 0;  ///< samples found sticking or standing still
};
UsableIntervals usable_intervals(const RecordingView& recording, bool mask_standstill,
                                 const base::Cancel* cancel = nullptr);
/// The same of a fragment; one in which the joint stands still throughout has nothing usable.
UsableIntervals usable_intervals(const RecordingView& recording, const MotionScale& scale,
                                 bool mask_standstill, const base::Cancel* cancel = nullptr);

}  // namespace jointid::identify
