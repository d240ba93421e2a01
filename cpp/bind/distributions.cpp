#include "base/normal.hpp"
#include "base/student.hpp"
#include "bind/bind.hpp"

namespace jointid::bind {

void bind_distributions(py::module_& m) {
  m.def("student_quantile", &base::student_quantile, py::arg("probability"), py::arg("freedom"),
        "Return the value below which Student's t lies with this probability.");
  m.def("chi_square_quantile", &base::chi_square_quantile, py::arg("tail"), py::arg("freedom"),
        "Return the value beyond which chi-square lies with this probability.");
  m.def("covering_half_width", &base::covering_half_width, py::arg("probability"),
        py::arg("offset"),

        "Return half the width of the symmetric interval that covers a normal variable with mean "
        "`offset` and standard deviation 1 with this probability.");
}

}  // namespace jointid::bind
