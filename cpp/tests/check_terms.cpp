// Terms: bases and their derivatives, keys and names.

#include "check.hpp"
#include "identify/balance/terms.hpp"

namespace jointid::tests {
namespace {

using model::SpeedBasis;

CHECK_CASE("terms: the general decay's derivatives are its differences") {
  const double shapes[] = {0.13, 1.7};
  for (const double v : {0.0, 0.01, 0.13, 0.9}) {
    for (int which = 0; which < 2; ++which) {
      double above[] = {shapes[0], shapes[1]};
      double below[] = {shapes[0], shapes[1]};
      above[which] += 1e-6;
      below[which] -= 1e-6;
      const auto value = [&](const double* s) {
        return model::basis_value(SpeedBasis::stribeck_general, v, s);
      };
      CHECK_CLOSE(model::basis_slope(SpeedBasis::stribeck_general, v, shapes, which),
                  (value(above) - value(below)) / 2e-6, 1e-8);
    }
  }
  const double gaussian[] = {0.1, 2.0};
  const double shape = 100.0;  // 1 / 0.1^2: exponent 2 is (4-1)
  CHECK_CLOSE(model::basis_value(SpeedBasis::stribeck_general, 0.07, gaussian),
              model::basis_value(SpeedBasis::stribeck, 0.07, &shape), 1e-15);
}

CHECK_CASE("terms: keys and names") {
  CHECK(identify::find_term("static_general").name == "static");
  CHECK(identify::find_term("ripple_cos_2").order == 2.0);
  for (const char* bad :
       {"ripple_cos", "ripple_cos_", "ripple_cos_x", "ripple_cos_-2", "coulom", ""}) {
    CHECK_REFUSED(identify::find_term(bad), "unknown term");
  }
  for (const char* good :
       {"inertia", "stribeck", "stribeck_exponent", "ripple_sin_2.5", "torque_offset[12]"}) {
    CHECK(identify::is_parameter(good));
  }
  for (const char* bad :
       {"static_general", "ripple_sin", "torque_offset[]", "torque_offset[x]", "x[1]", ""}) {
    CHECK(!identify::is_parameter(bad));
  }
}

}  // namespace
}  // namespace jointid::tests
