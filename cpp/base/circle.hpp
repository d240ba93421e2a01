#pragma once
// Cosine and sine of many angles in the host's vectors, with the same bits as one by one.

#include <cstddef>

namespace jointid::base {

void circle(const double* angle, std::size_t count, double* cosine, double* sine);

}  // namespace jointid::base
