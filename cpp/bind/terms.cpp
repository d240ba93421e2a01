#include "identify/terms.hpp"

#include "bind/bind.hpp"

namespace jointid::bind {

using identify::Model;
using identify::Shape;
using identify::Term;

void bind_terms(py::module_& m) {
  py::class_<Term>(m, "Term", "One term of the torque balance: a coefficient times a basis.")
      .def_property_readonly("name", [](const Term& t) { return std::string(t.name); })
      .def_property_readonly(
          "shape", [](const Term& t) { return std::string(t.shape); },
          "Name of the shape parameter; empty without one.")
      .def_readonly("non_negative", &Term::non_negative)
      .def_property_readonly("friction", &identify::is_friction,
                             "True if the term belongs to the friction map.")
      .def_property_readonly("unit", [](const Term& t) { return std::string(t.unit); })
      .def_property_readonly("unit_prismatic",
                             [](const Term& t) { return std::string(t.unit_prismatic); })
      .def_property_readonly("meaning", [](const Term& t) { return std::string(t.meaning); });
  py::class_<Shape>(m, "Shape", "A shape parameter: it bends the basis of a term.")
      .def_property_readonly("name", [](const Shape& s) { return std::string(s.name); })
      .def_property_readonly("unit", [](const Shape& s) { return std::string(s.unit); })
      .def_property_readonly("unit_prismatic",
                             [](const Shape& s) { return std::string(s.unit_prismatic); })
      .def_property_readonly("meaning", [](const Shape& s) { return std::string(s.meaning); });
  py::class_<Model>(m, "Model", "A friction model by name, as the terms it consists of.")
      .def_property_readonly("name", [](const Model& s) { return std::string(s.name); })
      .def_property_readonly("equation", [](const Model& s) { return std::string(s.equation); })
      .def_property_readonly("terms", [](const Model& s) {
        return std::vector<std::string>(s.terms.begin(), s.terms.end());
      });
  m.def("terms", [] { return identify::term_table(); }, "All terms, in canonical order.");
  m.def("shapes", [] { return identify::shape_table(); }, "All shape parameters.");
  m.def("models", [] { return identify::model_table(); }, "All friction models.");
  m.def(
      "friction_basis",
      [](const std::string& term, const Eigen::VectorXd& velocity, double shape) {
        return identify::friction_basis(identify::find_term(term), velocity, shape);
      },
      py::arg("term"), py::arg("velocity"), py::arg("shape") = 0.0,
      "The friction term's basis at each velocity [rad/s or m/s]: what its coefficient "
      "multiplies.");
  m.def("model_names", [] {
    std::vector<std::string> names;
    for (const auto& model : identify::model_table()) names.emplace_back(model.name);
    return py::tuple(py::cast(names));
  });
  m.def(
      "parameter_names",
      [] {
        std::vector<std::string> names;
        for (const auto& term : identify::term_table()) {
          names.emplace_back(term.name);
          if (!term.shape.empty()) names.emplace_back(term.shape);
        }
        return py::tuple(py::cast(names));
      },
      "All parameters, a shape parameter behind the term it bends.");
}

}  // namespace jointid::bind
