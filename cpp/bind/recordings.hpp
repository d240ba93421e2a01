#pragma once
// The recordings of one problem as Python passes them.

#include <cstdint>
#include <memory>
#include <vector>

#include "bind/recording.hpp"
#include "identify/penalty/penalty.hpp"

namespace jointid::bind {

using Recordings = std::vector<std::shared_ptr<SharedRecording>>;

inline std::int64_t samples_of(const Recordings& recordings) {
  std::int64_t samples = 0;
  for (const auto& recording : recordings) samples += recording->samples();
  return samples;
}

inline identify::Penalty::Masked all_masked(const Recordings& recordings, bool mask_standstill,
                                            base::Pool* pool) {
  identify::Penalty::Masked masked;
  for (const auto& recording : recordings)
    masked.push_back(recording->masked(mask_standstill, pool));
  return masked;
}

}  // namespace jointid::bind
