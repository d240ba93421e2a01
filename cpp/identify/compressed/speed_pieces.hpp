#pragma once
// Pieces of the speed's range on which every general decay of a domain is a short polynomial.
//
// exp(-|v/v_s|^d) depends on d log(v/v_s) alone and is smooth in it. So the columns of all shapes
// come from one pass over the samples: a window's Chebyshev moments of log v over each piece, and
// the decay at the pieces' Chebyshev points.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace jointid::identify {

/// Ranges of the two shapes.
struct GeneralRange {
  double velocity_low;
  double velocity_high;
  double exponent_low;
  double exponent_high;
};

/// Moment 0 is of the speeds below all pieces, where the joint rests for every shape.
struct SpeedPieces {
  double left = 0.0;               ///< log speed at which the first piece begins
  double width = 1.0;              ///< of a piece, in log speed
  std::vector<std::size_t> first;  ///< moments of piece p: first[p] .. first[p + 1] - 1

  [[nodiscard]] std::size_t moments() const { return first.back(); }
  [[nodiscard]] std::size_t pieces() const { return first.size() - 1; }
  /// log speed of each moment's Chebyshev point; of moment 0 a number that stands for rest.
  [[nodiscard]] std::vector<double> points() const;
};

/// Pieces for speeds from e^least, the lowest above 0, to e^most. Nothing when the range takes more
/// moments than pay, for the `reason` given.
std::optional<SpeedPieces> speed_pieces(const GeneralRange& range, double least, double most,
                                        std::string& reason);

/// Which moments a row of them holds, the others are 0: begin <= index < end.
struct Span {
  std::size_t begin;
  std::size_t end;
};

/// Adds weighted moments of some speeds to a row, and the span of what was added to `span`.
void add_moments(const SpeedPieces& pieces, const double* logarithm, const double* weight,
                 std::size_t count, double* row, Span& span);

}  // namespace jointid::identify
