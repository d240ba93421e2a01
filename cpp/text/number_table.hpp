#pragma once
// A table of plain numbers in a text. What is not plain is left to a parser that can say what it
// is.

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string_view>

namespace jointid::text {

/// The numbers of all rows below the first `below` lines, or nothing: where a row has another
/// number of cells, or a cell is anything but a decimal number such as -1.5e-3 within blanks (not
/// empty, no inf or nan, finite and not below the smallest double). Each is the nearest double.
///
/// Lines end with \n or \r\n, the last one may end with the text; empty lines are passed over.
std::optional<Eigen::MatrixXd> number_table(std::string_view text, std::size_t below,
                                            char separator, std::size_t columns);

}  // namespace jointid::text
