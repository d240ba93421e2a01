#include "identify/balance/terms.hpp"

#include <algorithm>

#include "bind/bind.hpp"

namespace jointid::bind {

using identify::Model;
using identify::Shape;
using identify::Term;

void bind_terms(py::module_& m) {
  py::native_enum<identify::Control>(m, "Control", "enum.Enum",
                                     "How a model-based controller treats a term.")
      .value("refused", identify::Control::refused)
      .value("feedback", identify::Control::feedback)
      .value("compensated", identify::Control::compensated)
      .finalize();
  py::class_<Term>(m, "Term", "One term of the torque balance: a coefficient times a basis.")
      .def_readonly("key", &Term::key, "Unique key by which a model lists the term.")
      .def_readonly("name", &Term::name, "The parameter's name.")
      .def_readonly("shapes", &Term::shapes, "Names of the basis's shape parameters.")
      .def_readonly("non_negative", &Term::non_negative)
      .def_property_readonly("friction", &identify::is_friction,
                             "Whether the term opposes motion, and so belongs to the friction map.")
      .def_property_readonly(
          "needs_load", &identify::needs_load,
          "Whether the term is friction that also depends on the drive's torque.")
      .def_property_readonly(
          "basis",
          [](const Term& t) {
            if (!identify::is_friction(t)) return std::string();
            return std::string(identify::needs_load(t) ? "load" : base::word(t.basis));
          },
          "Factor of the friction coefficient: \"constant\", \"linear\", \"load\" or a basis of "
          "the core.")
      .def_property_readonly(
          "expression", &identify::expression_of,
          "The friction basis as a product with `speed`, `load_size` and shapes by name; empty: 1.")
      .def_property_readonly(
          "at_rest",
          [](const Term& t) {
            return identify::needs_load(t) ? 1.0 : model::facts_of(t.basis).at_rest;
          },
          "The friction basis at a vanishing speed.")
      .def_property_readonly(
          "settles",
          [](const Term& t) {
            return identify::is_friction(t) && !identify::needs_load(t) &&
                   t.integral != identify::Integral::displacement &&
                   model::facts_of(t.basis).settles;
          },
          "Whether the friction basis is 1 in fast motion, as for Coulomb friction.")
      .def_property_readonly(
          "side", [](const Term& t) { return identify::side_of(t); },
          "1 or -1: friction of this direction of motion only; 0: of both directions.")
      .def_property_readonly(
          "above_zero", [](const Term& t) { return model::facts_of(t.basis).shape_above; },
          "Whether its shape parameters must be above 0.")
      .def_property_readonly(
          "behind_gear",
          [](const Term& t) { return t.integral == identify::Integral::link_friction; },
          "Whether the term is friction that grows with the torque behind the gear.")
      .def_property_readonly(
          "family",
          [](const Term& t) {
            return t.harmonic != identify::Harmonic::none || identify::is_own(t);
          },

          "True if the row represents one term per order, as in ripple_sin_2, or per signal.")
      .def_property_readonly("own", &identify::is_own,
                             "True for a term of a named signal, such as viscous_of_q6.")
      .def_readonly("unit", &Term::unit)
      .def_readonly("unit_prismatic", &Term::unit_prismatic)
      .def_readonly("meaning", &Term::meaning)
      .def_readonly("advice", &Term::advice, "Motion that determines the coefficient.")
      .def_readonly("option", &Term::option,
                    "Option that adds the term: \"name\" is a friction model, any other word an "
                    "option of the model; empty: always present.")
      .def_readonly("simulated", &Term::simulated, "Whether the simulated joint has the term.")
      .def_readonly("control", &Term::control);
  py::class_<Shape>(m, "Shape", "A shape parameter. The basis of a term is not linear in it.")
      .def_readonly("name", &Shape::name)
      .def_readonly("unit", &Shape::unit)
      .def_readonly("unit_prismatic", &Shape::unit_prismatic)
      .def_readonly("meaning", &Shape::meaning)
      .def_readonly("advice", &Shape::advice, "Motion that determines the parameter.")
      .def_readonly("speed_power", &Shape::speed_power,

                    "Default bounds are shares of the peak speed to this power; with 0, `lower` "
                    "and `upper` hold.")
      .def_readonly("lower", &Shape::lower, "Default bound where speed_power is 0.")
      .def_readonly("upper", &Shape::upper, "Default bound where speed_power is 0.")
      .def_readonly("typical", &Shape::typical, "A usual value where speed_power is 0.");
  py::class_<Model>(m, "Model", "A friction model: its name and the keys of its terms.")
      .def_readonly("name", &Model::name)
      .def_readonly("equation", &Model::equation)
      .def_readonly("terms", &Model::terms);
  m.def("terms", &identify::term_table, "Return all terms, in canonical order.");
  m.def("shapes", &identify::shape_table, "Return all shape parameters.");
  m.def("models", &identify::model_table, "Return all friction models.");
  m.def("term", &identify::find_term, py::arg("key"),
        "Return the term with this key. \"ripple_sin_2\" is order 2 of its family; viscous_of_q6 "
        "is the term of signal q6.");
  m.def("shape", &identify::find_shape, py::arg("name"),
        "Return the shape parameter with this name.");
  m.def("model_terms", &identify::model_terms, py::arg("name"), py::kw_only(),
        py::arg("asymmetric") = false,
        "Return the keys of a friction model's terms. `asymmetric` gives two per term, one for "
        "each direction of motion.");
  m.def("is_parameter", &identify::is_parameter, py::arg("name"),
        "Whether a parameter can have this name.");
  m.def(
      "friction_basis",
      [](const std::string& key, const Eigen::VectorXd& velocity, const Eigen::VectorXd& shapes,
         double load) {
        return identify::friction_basis(identify::find_term(key), velocity, shapes, load);
      },
      py::arg("key"), py::arg("velocity"), py::arg("shapes"), py::arg("load") = 0.0,
      "Return the friction term's basis, the factor of its coefficient, at each velocity [rad/s or "
      "m/s] while the drive transmits a load [N·m or N].");
  m.def("model_names", [] {
    std::vector<std::string> names;
    for (const auto& model : identify::model_table()) names.emplace_back(model.name);
    return py::tuple(py::cast(names));
  });
  m.def(
      "parameter_names",
      [] {
        std::vector<std::string> names;
        const auto add = [&](const std::string& name) {
          if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        };
        for (const auto& term : identify::term_table()) {
          if (term.harmonic != identify::Harmonic::none || identify::is_own(term)) continue;
          add(term.name);
          for (const auto& shape : term.shapes) add(shape);
        }
        return py::tuple(py::cast(names));
      },
      "Return all parameters except the harmonics, each shape parameter after its first term.");
}

}  // namespace jointid::bind
