#include "diagnose/inspection.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "identify/penalty/penalty_parts.hpp"

namespace jointid::diagnose {

Inspection inspect(const Subject& s, base::Pool* pool) {
  Inspection result;
  std::vector<std::function<void()>> tasks;
  const base::Cancel* cancel = pool != nullptr ? &pool->cancel() : nullptr;
  const auto speeds = extremes(s.velocity);
  result.peak_speed = std::max(std::fabs(speeds.lowest), std::fabs(speeds.highest));
  result.facts.resize(s.channels.size());
  result.spikes.resize(s.channels.size());
  if (!s.velocity_derived) {
    tasks.emplace_back([&] {
      result.agreement = velocity_agreement(s.time, s.position, s.velocity, s.period, cancel);
    });
  }
  tasks.emplace_back(
      [&] { result.timing = signals::timing_errors(s.time, s.position, s.period, cancel); });
  tasks.emplace_back([&] {
    result.position = extremes(s.position);
    result.jump = largest_jump(s.time, s.position, cancel);
  });
  for (std::size_t c = 0; c < s.channels.size(); ++c) {
    tasks.emplace_back([&, c] {
      result.facts[c] =
          inspect_signal(s.channels[c].values, s.velocity, result.peak_speed, s.period, cancel);
    });
    if (!s.channels[c].look_for_spikes) continue;
    tasks.emplace_back([&, c] {
      result.spikes[c] = largest_spike(s.channels[c].values, s.channels[c].rule, s.velocity,
                                       result.peak_speed, cancel);
    });
  }
  identify::for_each(tasks.size(), pool, [&](std::size_t i) { tasks[i](); });
  return result;
}

}  // namespace jointid::diagnose
