#pragma once
// Several doubles in parallel, so that one source serves a single simulation and a batch. Each lane
// does exactly the scalar arithmetic: a lane's bits do not depend on its neighbours.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/elementary.hpp"

namespace jointid::base {

// Operations of generic code, for a single number.
inline double select(bool mask, double yes, double no) {
  return mask ? yes : no;
}
inline bool any(bool mask) {
  return mask;
}
inline double absolute(double x) {
  return std::fabs(x);
}
inline double at_least(double x, double low) {
  return x < low ? low : x;
}

namespace detail {

#if defined(__GNUC__)
// Every x86-64 and every AArch64 has a register for a pair.
using Pair = double __attribute__((vector_size(16)));
using PairMask = decltype(Pair{} < Pair{});
inline Pair pick(PairMask mask, Pair yes, Pair no) {
  return mask ? yes : no;
}
inline Pair both(double x) {
  return Pair{x, x};
}
#define JOINTID_PAIRS 1
#else
struct PairMask {
  long long lane[2];
  long long operator[](std::size_t i) const { return lane[i]; }
};
struct Pair {
  double lane[2];
  double operator[](std::size_t i) const { return lane[i]; }
  double& operator[](std::size_t i) { return lane[i]; }
};
inline Pair operator+(Pair a, Pair b) {
  return {{a[0] + b[0], a[1] + b[1]}};
}
inline Pair operator-(Pair a, Pair b) {
  return {{a[0] - b[0], a[1] - b[1]}};
}
inline Pair operator*(Pair a, Pair b) {
  return {{a[0] * b[0], a[1] * b[1]}};
}
inline Pair operator/(Pair a, Pair b) {
  return {{a[0] / b[0], a[1] / b[1]}};
}
inline Pair operator-(Pair a) {
  return {{-a[0], -a[1]}};
}
inline PairMask operator<(Pair a, Pair b) {
  return {{-(a[0] < b[0]), -(a[1] < b[1])}};
}
inline PairMask operator==(Pair a, Pair b) {
  return {{-(a[0] == b[0]), -(a[1] == b[1])}};
}
inline PairMask operator&(PairMask a, PairMask b) {
  return {{a[0] & b[0], a[1] & b[1]}};
}
inline PairMask operator|(PairMask a, PairMask b) {
  return {{a[0] | b[0], a[1] | b[1]}};
}
inline PairMask operator~(PairMask a) {
  return {{~a[0], ~a[1]}};
}
inline Pair pick(PairMask mask, Pair yes, Pair no) {
  return {{mask[0] ? yes[0] : no[0], mask[1] ? yes[1] : no[1]}};
}
inline Pair both(double x) {
  return {{x, x}};
}
#endif

}  // namespace detail

/// True or false for each lane.
template <std::size_t Pairs>
struct LaneMask {
  std::array<detail::PairMask, Pairs> pair;

  friend LaneMask operator&(const LaneMask& a, const LaneMask& b) {
    return of([&](std::size_t i) { return a.pair[i] & b.pair[i]; });
  }
  friend LaneMask operator|(const LaneMask& a, const LaneMask& b) {
    return of([&](std::size_t i) { return a.pair[i] | b.pair[i]; });
  }
  friend LaneMask operator!(const LaneMask& a) {
    return of([&](std::size_t i) { return ~a.pair[i]; });
  }
  template <class Make>
  static LaneMask of(Make make) {
    LaneMask result;
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      ((result.pair[I] = make(I)), ...);
    }(std::make_index_sequence<Pairs>{});
    return result;
  }
};

/// 2 * Pairs doubles.
template <std::size_t Pairs>
struct Lanes {
  static constexpr std::size_t width = 2 * Pairs;
  using Mask = LaneMask<Pairs>;
  std::array<detail::Pair, Pairs> pair;

  Lanes() : Lanes(0.0) {}
  Lanes(double same) {
    pair.fill(detail::both(same));
  }  // a number among lanes has the same value in all lanes

  Lanes(double a, double b, double c, double d)
    requires(Pairs == 2)
      : pair{detail::Pair{a, b}, detail::Pair{c, d}} {}

  [[nodiscard]] double operator[](std::size_t i) const { return pair[i / 2][i % 2]; }
  void set(std::size_t i, double value) { pair[i / 2][i % 2] = value; }

  template <class Make>
  static Lanes of(Make make) {
    Lanes result;
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      ((result.pair[I] = make(I)), ...);
    }(std::make_index_sequence<Pairs>{});
    return result;
  }
  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return of([&](std::size_t i) { return a.pair[i] + b.pair[i]; });
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return of([&](std::size_t i) { return a.pair[i] - b.pair[i]; });
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return of([&](std::size_t i) { return a.pair[i] * b.pair[i]; });
  }
  friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return of([&](std::size_t i) { return a.pair[i] / b.pair[i]; });
  }
  friend Lanes operator-(const Lanes& a) {
    return of([&](std::size_t i) { return -a.pair[i]; });
  }
  friend Mask operator<(const Lanes& a, const Lanes& b) {
    return Mask::of([&](std::size_t i) { return a.pair[i] < b.pair[i]; });
  }
  friend Mask operator==(const Lanes& a, const Lanes& b) {
    return Mask::of([&](std::size_t i) { return a.pair[i] == b.pair[i]; });
  }
};

template <std::size_t P>
Lanes<P> select(const LaneMask<P>& mask, const Lanes<P>& yes, const Lanes<P>& no) {
  return Lanes<P>::of(
      [&](std::size_t i) { return detail::pick(mask.pair[i], yes.pair[i], no.pair[i]); });
}
template <std::size_t P>
bool any(const LaneMask<P>& mask) {
  detail::PairMask found = mask.pair[0];
  for (std::size_t i = 1; i < P; ++i) found = found | mask.pair[i];
  return (found[0] | found[1]) != 0;
}
template <std::size_t P>
Lanes<P> at_least(const Lanes<P>& x, double low) {
  return select(x < Lanes<P>(low), Lanes<P>(low), x);
}

/// A scalar function of each lane.
template <std::size_t P, class Function>
Lanes<P> each_lane(const Lanes<P>& x, Function function) {
  std::array<double, 2 * P> values;
  for (std::size_t i = 0; i < 2 * P; ++i) values[i] = x[i];
  for (double& value : values) value = function(value);
  Lanes<P> result;
  for (std::size_t i = 0; i < 2 * P; ++i) result.set(i, values[i]);
  return result;
}
#ifdef JOINTID_PAIRS
namespace detail {

using Bits = unsigned long long __attribute__((vector_size(16)));

// The series of base/elementary.hpp for two values: the same operations, the same bits.
template <>
struct Form<Pair> {
  using Bits = detail::Bits;
  static Bits bits(Pair x) { return (Bits)x; }
  static Pair value(Bits bits) { return (Pair)bits; }
  static Pair choose(PairMask mask, Pair yes, Pair no) { return pick(mask, yes, no); }
};

/// sin (`ahead` 0) or cos (1) of |x| < 1.6e6; `ahead` is the lead over the sine in quarter turns.
inline Pair sine(Pair x, unsigned long long ahead) {
  const auto reduced = reduce(x);
  const Bits quadrant = reduced.quadrant + ahead;
  const Bits odd = quadrant & 1ULL;
  Pair value;
  if (odd[0] == odd[1]) {  // usual case: one series serves both
    value = odd[0] != 0 ? cos_series(reduced.r, reduced.tail) : sin_series(reduced.r, reduced.tail);
  } else {
    value =
        pick(odd != 0ULL, cos_series(reduced.r, reduced.tail), sin_series(reduced.r, reduced.tail));
  }
  return (Pair)((Bits)value ^ (((quadrant >> 1ULL) & 1ULL) << 63ULL));
}

inline bool within(Pair x, double limit) {
  return std::fabs(x[0]) < limit && std::fabs(x[1]) < limit;
}

}  // namespace detail

template <std::size_t P>
Lanes<P> absolute(const Lanes<P>& x) {
  return Lanes<P>::of([&](std::size_t i) {
    return (detail::Pair)((detail::Bits)x.pair[i] & 0x7fffffffffffffffULL);
  });
}
template <std::size_t P>
Lanes<P> exp(const Lanes<P>& x) {
  return Lanes<P>::of([&](std::size_t i) { return detail::exp(x.pair[i]); });
}
template <std::size_t P>
Lanes<P> cos(const Lanes<P>& x) {
  return Lanes<P>::of([&](std::size_t i) {
    const detail::Pair own = x.pair[i];
    return detail::within(own, 1.6e6) ? detail::sine(own, 1)
                                      : detail::Pair{cos(own[0]), cos(own[1])};
  });
}
template <std::size_t P>
Lanes<P> sin(const Lanes<P>& x) {
  return Lanes<P>::of([&](std::size_t i) {
    const detail::Pair own = x.pair[i];
    return detail::within(own, 1.6e6) ? detail::sine(own, 0)
                                      : detail::Pair{sin(own[0]), sin(own[1])};
  });
}
#else
template <std::size_t P>
Lanes<P> absolute(const Lanes<P>& x) {
  return each_lane(x, [](double value) { return std::fabs(value); });
}
template <std::size_t P>
Lanes<P> exp(const Lanes<P>& x) {
  return each_lane(x, [](double value) { return exp(value); });
}
template <std::size_t P>
Lanes<P> cos(const Lanes<P>& x) {
  return each_lane(x, [](double value) { return cos(value); });
}
template <std::size_t P>
Lanes<P> sin(const Lanes<P>& x) {
  return each_lane(x, [](double value) { return sin(value); });
}
#endif
template <std::size_t P>
Lanes<P> pow(const Lanes<P>& x, const Lanes<P>& y) {
  Lanes<P> result;
  for (std::size_t i = 0; i < 2 * P; ++i) result.set(i, pow(x[i], y[i]));
  return result;
}

/// One lane of a number or of lanes.
inline double lane(double x, std::size_t) {
  return x;
}
template <std::size_t P>
double lane(const Lanes<P>& x, std::size_t i) {
  return x[i];
}
inline void set_lane(double& x, std::size_t, double value) {
  x = value;
}
template <std::size_t P>
void set_lane(Lanes<P>& x, std::size_t i, double value) {
  x.set(i, value);
}

template <class Number>
inline constexpr std::size_t lanes_of = 1;
template <std::size_t P>
inline constexpr std::size_t lanes_of<Lanes<P>> = Lanes<P>::width;

}  // namespace jointid::base
