// Bad input has its argument, value and reason; a bug does not look like bad input.

#include <cmath>
#include <string>

#include "base/choices.hpp"
#include "base/digits.hpp"
#include "base/require.hpp"
#include "check.hpp"
#include "model/joint.hpp"

namespace jointid::tests {
namespace {

using base::InputError;

template <class Call>
InputError refused(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error;
  }
  return InputError("nothing was refused");
}

CHECK_CASE("input error: a requirement names the number, its value and its limit") {
  const base::Requirement require("joint");
  const auto low = refused([&] { require.above_zero("inertia", -2.5); });
  CHECK(low.argument() == "joint.inertia");
  CHECK(std::get<double>(low.value()) == -2.5);
  CHECK(low.reason() == "must be finite and above 0");
  CHECK(std::string(low.what()) == "joint.inertia is -2.5: must be finite and above 0");
  const auto whole = refused([&] { require.that(false, "order", 3, "0, 1 or 2"); });
  CHECK(std::get<std::int64_t>(whole.value()) == 3);
  CHECK(std::string(whole.what()) == "joint.order is 3: must be 0, 1 or 2");
  require.finite("load", 0.0);
  CHECK(std::isnan(std::get<double>(refused([&] { require.finite("x", std::nan("")); }).value())));
}

CHECK_CASE("input error: an unknown word lists the known ones") {
  const auto error = refused([] { base::chosen<model::SpeedBasis>("square"); });
  CHECK(std::string(error.what()) ==
        "basis is 'square': choose one of constant, linear, gaussian, general, rising");
  CHECK(std::get<std::string>(error.value()) == "square");
}

CHECK_CASE("input error: a sentence without argument or value is the reason") {
  CHECK(std::string(InputError("nothing moves").what()) == "nothing moves");
  CHECK(std::string(InputError("too long", "windows").what()) == "windows: too long");
}

CHECK_CASE("input error: numbers have the requested digits, and no trailing zeros") {
  CHECK(base::with_digits(-2.5, 15) == "-2.5");
  CHECK(base::with_digits(1e-14, 2) == "1e-14");
  CHECK(base::with_digits(1.0 / 3.0, 10) == "0.3333333333");
  CHECK(base::with_digits(0.1, 17) == "0.10000000000000001");
  CHECK(base::with_digits(123456.0, 2) == "1.2e+05");
  CHECK(base::with_digits(-1.2345678901234567e-308, 17) == "-1.2345678901234567e-308");
  CHECK(base::with_digits(HUGE_VAL, 15) == "inf");
  CHECK(base::with_digits(-HUGE_VAL, 15) == "-inf");
}

CHECK_CASE("input error: a number has a point, whatever the locale writes") {
  CHECK(base::with_point("-2,5") == "-2.5");
  CHECK(base::with_point("1\xd9\xab"
                         "5e+05") == "1.5e+05");  // of two bytes
  CHECK(base::with_point("1e-14") == "1e-14");
}

}  // namespace
}  // namespace jointid::tests
