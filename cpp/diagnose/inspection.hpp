#pragma once
// All checks of a recording that need no model, as tasks of one pool.

#include <optional>
#include <vector>

#include "base/pool.hpp"
#include "diagnose/consistency.hpp"
#include "diagnose/spikes.hpp"
#include "signals/timing.hpp"

namespace jointid::diagnose {

/// A signal to examine.
struct Channel {
  Signal values;
  SpikeRule rule;
  bool look_for_spikes;
};

struct Subject {
  Signal time;
  Signal position;
  Signal velocity;
  bool velocity_derived;
  double period;  ///< [s]
  std::vector<Channel> channels;
};

struct Inspection {
  double peak_speed = 0.0;
  Extremes position;
  std::vector<SignalFacts> facts;  ///< one per channel
  std::vector<Spike> spikes;       ///< one per channel
  std::int64_t jump = -1;
  std::optional<Agreement> agreement;  ///< none if the velocity is derived
  signals::TimingErrors timing;
};

Inspection inspect(const Subject& subject, base::Pool* pool);

}  // namespace jointid::diagnose
