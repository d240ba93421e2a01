// The usable parts of a recording (the mask), and its division into windows.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "base/random.hpp"
#include "check.hpp"
#include "identify/recording/windows.hpp"

namespace jointid::tests {
namespace {

using identify::Recording;
using identify::usable_intervals;
using identify::Window;

constexpr double kPeriod = 0.001;

/// Position from a velocity profile by exact integration of its straight pieces.
template <class Velocity>
Recording driven(int samples, Velocity velocity) {
  Recording r;
  r.time = Eigen::VectorXd::LinSpaced(samples, 0.0, (samples - 1) * kPeriod);
  r.velocity.resize(samples);
  r.position.setZero(samples);
  r.torque.setZero(samples);
  for (Eigen::Index k = 0; k < samples; ++k) r.velocity[k] = velocity(r.time[k]);
  for (Eigen::Index k = 1; k < samples; ++k) {
    r.position[k] = r.position[k - 1] + 0.5 * kPeriod * (r.velocity[k] + r.velocity[k - 1]);
  }
  return r;
}

Recording swinging(int samples = 4000) {  // period 2 s, peak speed pi
  return driven(samples,
                [](double t) { return std::numbers::pi * std::cos(std::numbers::pi * t + 0.3); });
}

std::int64_t unusable(const std::vector<std::uint8_t>& usable) {
  return std::count(usable.begin(), usable.end(), std::uint8_t{0});
}

/// All intervals within `reach` of the samples first..last are out, and no others.
bool masks_exactly(const std::vector<std::uint8_t>& usable, std::int64_t first, std::int64_t last,
                   std::int64_t reach) {
  for (std::int64_t k = 0; k < static_cast<std::int64_t>(usable.size()); ++k) {
    const bool out = k + 1 > first - reach && k < last + reach;
    if ((usable[static_cast<std::size_t>(k)] == 0) != out) return false;
  }
  return true;
}

CHECK_CASE("windows: a moving joint is used throughout, plain reversals included") {
  const auto all = usable_intervals(swinging(), true);
  CHECK(all.standing == 0);
  CHECK_CLOSE(unusable(all.usable), 0, 0.0);
  // The same from an encoder: at each of the four reversals its count is constant for up to 9 ms,
  // which looks like sticking. No more than that may be lost.
  for (const double quantum : {1e-6, 7.8e-6, 1e-4}) {
    Recording r = swinging();
    r.position = (r.position / quantum).array().round() * quantum;
    CHECK_CLOSE(unusable(usable_intervals(r, true).usable), 0, 4 * (9 + 4));
  }
}

CHECK_CASE("windows: a run that sticks is left out, with two intervals on either side") {
  const double stop = 0.9005;
  const double go = 1.1995;
  const auto r = driven(3000, [&](double t) {
    if (t > stop && t < go) return 0.0;
    return std::cos(3.0 * (t - stop)) + 2.0;  // comes to rest from full speed
  });
  const auto mask = usable_intervals(r, true);
  // Velocity is zero at samples 901..1199; position does not change from sample 901 to 1199.
  CHECK(masks_exactly(mask.usable, 901, 1199, 2));
  CHECK_CLOSE(mask.standing, 299, 0.0);
  const auto unmasked = usable_intervals(r, false);
  CHECK_CLOSE(unusable(unmasked.usable), 0, 0.0);
}

CHECK_CASE("windows: a velocity of exactly zero sticks even if the position is noisy") {
  auto r = driven(3000, [](double t) { return t > 1.0005 && t < 1.2 ? 0.0 : 2.0 + std::sin(t); });
  base::Random random(3, 0, 0, 0);
  r.velocity[100] = 1e-4;  // the velocity has a fine resolution: zero is zero
  for (Eigen::Index k = 0; k < 3000; ++k) r.position[k] += 1e-4 * random.uniform();
  const auto mask = usable_intervals(r, true);
  CHECK(masks_exactly(mask.usable, 1001, 1199, 2));
}

CHECK_CASE("windows: creeping is standing still, slow motion is not") {
  const auto creeping = [](double fraction) {
    return driven(4000, [&](double t) {
      return t > 1.5 && t < 2.5 ? fraction * std::numbers::pi
                                : std::numbers::pi * std::sin(std::numbers::pi * t);
    });
  };
  const auto slow = usable_intervals(creeping(0.02), true);
  CHECK_CLOSE(unusable(slow.usable), 0, 0.0);
  const auto still = usable_intervals(creeping(0.001), true);
  const auto middle = still.usable.begin() + 1550;
  CHECK(std::all_of(middle, middle + 900, [](std::uint8_t flag) { return flag == 0; }));
  CHECK_WITH(unusable(still.usable) < 1050, std::to_string(unusable(still.usable)));
}

CHECK_CASE("windows: a gap is unusable and no window crosses it") {
  auto r = swinging(1000);
  r.gap_after = {700, 200};  // in any order
  for (const auto gap : r.gap_after) {
    r.time.tail(999 - gap).array() += 0.5;
  }
  const auto usable = usable_intervals(r, true).usable;
  CHECK(usable[200] == 0);
  CHECK(usable[700] == 0);
  CHECK_CLOSE(unusable(usable), 2, 0.0);
  for (const double duration : {0.003, 0.0171, 0.1, 0.4, 5.0}) {
    const auto windows = identify::cut_windows(r, usable, duration);
    std::int64_t covered = 0;
    for (const auto& window : windows) {
      CHECK(window.begin < window.end);
      CHECK(!(window.begin <= 200 && 200 < window.end));
      CHECK(!(window.begin <= 700 && 700 < window.end));
      covered += window.end - window.begin;
    }
    CHECK_CLOSE(covered, 997, 0.0);
    for (std::size_t w = 1; w < windows.size(); ++w) CHECK(windows[w].begin >= windows[w - 1].end);
  }
}

CHECK_CASE("windows: a doubtful interval is unusable, and windows continue after it") {
  auto r = swinging(1000);
  auto view = identify::RecordingView(r);
  view.doubtful = {500};
  view.validate();
  for (const bool standstill : {false, true}) {
    const auto usable = usable_intervals(view, standstill).usable;
    CHECK(usable[500] == 0);
    CHECK_CLOSE(unusable(usable), 1, 0.0);
    CHECK_CLOSE(identify::cut_windows(r, usable, 0.1).size(),
                identify::cut_windows(r, usable_intervals(r, standstill).usable, 0.1).size(), 0.0);
  }
  for (const std::int64_t outside : {std::int64_t{-1}, std::int64_t{999}}) {
    view.doubtful = {outside};
    bool refused = false;
    try {
      view.validate();
    } catch (const std::invalid_argument&) {
      refused = true;
    }
    CHECK(refused);
  }
}

CHECK_CASE("windows: a gap that ends where it began is not a standstill") {
  auto r = swinging(3000);
  // The joint passes a place, the recording has a gap, and it continues at the same place a period
  // later.
  r.gap_after = {1499};
  r.time.tail(1500).array() += 0.5;
  r.position.tail(1500).array() += r.position[1499] - r.position[1500];
  const auto usable = usable_intervals(r, true).usable;
  CHECK_CLOSE(unusable(usable), 1, 0.0);
}

CHECK_CASE("windows: the requested number, or the requested length") {
  const auto r = swinging(3001);  // 3 s
  const auto usable = usable_intervals(r, true).usable;
  for (const std::int64_t count : {1, 7, 50, 333, 1500, 3000}) {
    const auto windows = identify::cut_windows(r, usable, identify::duration_for({r}, count));
    CHECK_CLOSE(windows.size(), count, 0.0);
  }
  for (const double duration : {0.01, 0.025, 0.1}) {
    const auto windows = identify::cut_windows(r, usable, duration);
    for (const auto& window : windows) {
      CHECK_CLOSE(r.time[window.end] - r.time[window.begin], duration, 1.001 * kPeriod);
    }
  }
  CHECK_REFUSED(identify::duration_for({r}, 3001), "3001 windows");
  CHECK_REFUSED(identify::cut_windows(r, usable, 0.0), "duration must be positive");
}

CHECK_CASE("windows: one without a usable interval is left out") {
  const auto r = driven(3000, [](double t) { return t > 1.0 && t < 2.0 ? 0.0 : 2.0; });
  const auto usable = usable_intervals(r, true).usable;
  const auto windows = identify::cut_windows(r, usable, 0.05);
  for (const auto& window : windows) {
    const auto first = usable.begin() + window.begin;
    const auto last = usable.begin() + window.end;
    CHECK(std::any_of(first, last, [](std::uint8_t flag) { return flag != 0; }));
  }
  // 60 windows of 0.05 s; the second of standing still takes 19 or 20 whole ones.
  CHECK_CLOSE(windows.size(), 40.5, 1.0);
}

CHECK_CASE("windows: the duration follows the noise of the velocity") {
  const auto clean = swinging(8000);
  const std::vector<std::uint8_t> usable(7999, 1);
  const auto shortest = identify::choose_window(clean, usable, 4);
  CHECK_CLOSE(shortest.duration, 10 * kPeriod, 1e-12);
  CHECK(!shortest.noise_limited);
  CHECK_CLOSE(identify::choose_window(clean, usable, 4, {0, 0.25, 0.5}).duration, 0.125, 1e-12);
  double previous = 0.0;
  for (const double amplitude : {0.001, 0.01, 0.03}) {
    auto noisy = clean;
    base::Random random(5, 0, 0, 0);
    for (double& v : noisy.velocity) v += amplitude * (2.0 * random.uniform() - 1.0);
    const auto choice = identify::choose_window(noisy, usable, 4);
    CHECK_WITH(choice.duration >= previous, std::to_string(choice.duration));
    previous = choice.duration;
    // The noise adds twice its variance to D(lag); its share is reported.
    const auto lag = static_cast<Eigen::Index>(std::lround(choice.duration / kPeriod));
    const double change =
        (noisy.velocity.tail(8000 - lag) - noisy.velocity.head(8000 - lag)).squaredNorm() /
        static_cast<double>(8000 - lag);
    const double share = 2.0 * amplitude * amplitude / 3.0 / change;
    CHECK_CLOSE(choice.noise_share / share, 1.0, 0.15);
  }
  CHECK(previous > 2.0 * shortest.duration);
  auto hopeless = clean;
  base::Random random(6, 0, 0, 0);
  for (double& v : hopeless.velocity) v += 10.0 * random.uniform();
  const auto limited = identify::choose_window(hopeless, usable, 4);
  CHECK(limited.noise_limited);
  CHECK_CLOSE(limited.duration, 7999 / 80 * kPeriod,
              1e-9);  // at least 20 windows per parameter are kept
}

CHECK_CASE("windows: the shortest with a noise of a thousandth; a hundredth is reported") {
  auto noisy = swinging(8000);
  base::Random random(5, 0, 0, 0);
  for (double& v : noisy.velocity) v += 0.01 * (2.0 * random.uniform() - 1.0);
  const std::vector<std::uint8_t> usable(7999, 1);
  const auto chosen = identify::choose_window(noisy, usable, 4);
  const auto share = [&](double duration) {
    return identify::choose_window(noisy, usable, 4, {0, duration}).noise_share;
  };
  CHECK(chosen.duration > 10.5 * kPeriod);
  CHECK(chosen.noise_share <= 1e-3);
  CHECK(share(chosen.duration / 1.3) > 1e-3);
  int named = 0;
  int silent = 0;  // within a factor of two of the limit
  for (int lag = 1; lag < 60; ++lag) {
    const auto given = identify::choose_window(noisy, usable, 4, {0, lag * kPeriod});
    CHECK(given.noise_limited == (given.noise_share > 1e-2));
    if (given.noise_share > 1e-2 && given.noise_share < 2e-2) ++named;
    if (given.noise_share < 1e-2 && given.noise_share > 5e-3) ++silent;
  }
  CHECK(named > 0);
  CHECK(silent > 0);
}

CHECK_CASE("windows: impossible settings are refused in words") {
  CHECK_REFUSED((identify::WindowOptions{-1, 0.0}.validate()),
                "windows.count is -1: must be positive");
  CHECK_REFUSED((identify::WindowOptions{0, -0.5}.validate()),
                "windows.duration is -0.5: must be positive");
  CHECK_REFUSED((identify::WindowOptions{0, std::nan("")}.validate()),
                "windows.duration is nan: must be positive");
  CHECK_REFUSED((identify::WindowOptions{10, 0.5}.validate()), "not both");
  auto still = swinging(100);
  still.velocity.setZero();
  CHECK_REFUSED(usable_intervals(still, true), "never moves");
}

}  // namespace
}  // namespace jointid::tests
