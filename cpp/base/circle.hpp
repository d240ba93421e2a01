#pragma once
// Cosine and sine of many angles: the same bits as one by one, side by side in the host's vectors.

#include <cstddef>

namespace jointid::base {

void circle(const double* angle, std::size_t count, double* cosine, double* sine);

}  // namespace jointid::base
