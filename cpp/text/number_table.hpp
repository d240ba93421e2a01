#pragma once
// A table of plain numbers in a text. Any other table is left to a parser that can explain the
// fault.

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string_view>

namespace jointid::text {

/// The numbers of all rows after the first `below` lines. Nothing if a row has another number of
/// cells, or if a cell is not a decimal number such as -1.5e-3 within blanks (not empty, no inf or
/// nan, finite and not below the smallest double). Each number is the nearest double.
///
/// Lines end with \n or \r\n; the last one may end with the text. Empty lines are skipped.
std::optional<Eigen::MatrixXd> number_table(std::string_view text, std::size_t below,
                                            char separator, std::size_t columns);

}  // namespace jointid::text
