#include "base/normal.hpp"
#include "base/student.hpp"
#include "bind/bind.hpp"

namespace jointid::bind {

void bind_distributions(py::module_& m) {
  m.def("student_quantile", &base::student_quantile, py::arg("probability"), py::arg("freedom"),
        "Below which this probability of Student's t lies.");
  m.def("chi_square_quantile", &base::chi_square_quantile, py::arg("tail"), py::arg("freedom"),
        "Beyond which this probability of chi-square lies.");
  m.def("covering_half_width", &base::covering_half_width, py::arg("probability"),
        py::arg("offset"),

        "Half the width of the symmetric interval that holds a normal variable of this mean and "
        "deviation 1.");
}

}  // namespace jointid::bind
