#include <string_view>

#include "bind/bind.hpp"
#include "text/control_character.hpp"
#include "text/number_list.hpp"
#include "text/number_table.hpp"

namespace jointid::bind {

void bind_text(py::module_& m) {
  m.def(
      "number_table",
      [](std::string_view text, std::size_t below, char separator, std::size_t columns) {
        const py::gil_scoped_release nogil;
        return text::number_table(text, below, separator, columns);
      },
      py::arg("text"), py::arg("below"), py::arg("separator"), py::arg("columns"),
      "Return the numbers of all rows after the first `below` lines. None where a cell is not a "
      "plain number.");
  m.def(
      "number_list",
      [](const Eigen::VectorXd& values) {
        const py::gil_scoped_release nogil;
        return text::number_list({values.data(), static_cast<std::size_t>(values.size())});
      },
      py::arg("values"),
      "Return a list of finite numbers as JSON. None where Python has to write it.");
  m.def(
      "find_control_character",
      [](const py::bytes& content) -> py::ssize_t {
        const std::size_t found = text::find_control_character(std::string_view(content));
        return found == std::string_view::npos ? -1 : static_cast<py::ssize_t>(found);
      },
      py::arg("content"),

      "Return the index of the first byte that no text contains in any encoding; -1 if there is "
      "none.");
}

}  // namespace jointid::bind
