#include "bind/bind.hpp"
#include "bind/simulate.hpp"
#include "design/excitation.hpp"
#include "search/genetic.hpp"

namespace pybind11::detail {
template <>
struct type_caster<jointid::design::Criterion>
    : jointid::bind::ChoiceCaster<jointid::design::Criterion> {};
}  // namespace pybind11::detail

namespace jointid::bind {

using namespace design;

namespace {

Column column(const std::string& key, int shape, double coefficient, double frequency,
              std::vector<double> shapes) {
  Column made{identify::find_term(key), shape, coefficient, frequency, std::move(shapes)};
  if (made.term.shapes.size() > made.shapes.size()) {
    throw std::invalid_argument("the term " + key + " needs its shapes");
  }
  if (shape >= static_cast<int>(made.term.shapes.size())) {
    throw std::invalid_argument("the term " + key + " has fewer shapes");
  }
  return made;
}

void bind_values(py::module_& m) {
  value(m, "MotionBounds", "Bounds on the reference of a designed motion.",
        Field{"lowest", &Bounds::lowest, "Lowest position [rad]."},
        Field{"highest", &Bounds::highest, "Highest position [rad]."},
        Field{"velocity", &Bounds::velocity, "[rad/s]"},
        Field{"acceleration", &Bounds::acceleration, "[rad/s²]"},
        Field{"torque", &Bounds::torque, "Torque of the drive [N·m]."},
        Field{"inertia", &Bounds::inertia, "Largest inertia that the prior allows [kg·m²]."},
        Field{"viscous", &Bounds::viscous,
              "Largest viscous friction that the prior allows [N·m·s/rad]."},
        Field{"dry", &Bounds::dry,
              "Largest sum of dry friction and load that the prior allows [N·m]."});
  value(m, "MotionFamily", "Sums of sines that start and end at rest.",
        Field{"sines", &Family::sines, "Number of sines."},
        Field{"duration", &Family::duration, "[s]"},
        Field{"fade", &Family::fade, "Time over which the sines fade in and out [s]."},
        Field{"slowest", &Family::slowest, "Lowest frequency [rad/s]."},
        Field{"fastest", &Family::fastest, "Highest frequency [rad/s]."},
        Field{"bounds", &Family::bounds, "Bounds on the reference."});
  value(m, "HeldLimits", "Limits that the joints themselves must keep.",
        Field{"lowest", &Held::lowest, "Lowest position [rad]."},
        Field{"highest", &Held::highest, "Highest position [rad]."},
        Field{"velocity", &Held::velocity, "[rad/s]"},
        Field{"acceleration", &Held::acceleration, "[rad/s²]"},
        Field{"torque", &Held::torque, "Torque of the drive [N·m]."},
        Field{"link_torque", &Held::link_torque, "Torque at the torque sensor [N·m]."});
  value(m, "BalanceNoise",
        "Noise of the torque balance, and the samples that an identification leaves out.",
        Field{"torque", &Noise::torque, "White noise of one sample [N·m]."},
        Field{"position", &Noise::position, "Error at a window's end [rad]."},
        Field{"velocity", &Noise::velocity, "Error at a window's end [rad/s]."},
        Field{"slowest", &Noise::slowest, "Slower samples are left out [rad/s]."},
        Field{"reversal", &Noise::reversal,
              "Error of a window in which the velocity changes sign [N·m·s]."},
        Field{"sampled", &Noise::sampled, "Time between samples of the recording [s]."});
}

void bind_results(py::module_& m) {
  py::class_<Column>(m, "BalanceColumn", "Column of a free parameter in the torque balance.")
      .def(py::init(&column), py::kw_only(), py::arg("key"), py::arg("shape") = -1,
           py::arg("coefficient") = 0.0, py::arg("frequency") = 0.0,
           py::arg("shapes") = std::vector<double>{});
  py::class_<Drawn>(m, "DrawnJoint", "A joint that the prior allows.")
      .def(py::init([](simulate::Setup setup, std::vector<Column> columns, Noise noise,
                       Eigen::VectorXd scale, Eigen::VectorXd weight, Eigen::MatrixXd known,
                       double inertia, double viscous) {
             const auto count = static_cast<Eigen::Index>(columns.size());
             if (scale.size() != count || weight.size() != count || known.rows() != count ||
                 known.cols() != count) {
               throw std::invalid_argument("scale, weight and known must fit the columns");
             }
             return Drawn{std::move(setup),  std::move(columns), noise,   std::move(scale),
                          std::move(weight), std::move(known),   inertia, viscous};
           }),
           py::kw_only(), py::arg("setup"), py::arg("columns"), py::arg("noise"), py::arg("scale"),
           py::arg("weight"), py::arg("known"), py::arg("inertia"), py::arg("viscous"))
      .def_readonly("weight", &Drawn::weight, "1 for a requested parameter, 0 for any other.");
  py::class_<Judgement>(m, "MotionJudgement", "Value of a motion for one joint.")
      .def_readonly("errors", &Judgement::errors, "Expected errors (RMS) over their scales.")
      .def_readonly("bias", &Judgement::bias,
                    "The part of `errors` that is the same in every recording.")
      .def_readonly("information", &Judgement::information, "Information of this motion alone.")
      .def_readonly("lowest", &Judgement::lowest, "Lowest position that the joint reaches [rad].")
      .def_readonly("highest", &Judgement::highest,
                    "Highest position that the joint reaches [rad].")
      .def_readonly("velocity", &Judgement::velocity, "[rad/s]")
      .def_readonly("acceleration", &Judgement::acceleration, "[rad/s²]")
      .def_readonly("torque", &Judgement::torque, "Torque of the drive [N·m].")
      .def_readonly("link_torque", &Judgement::link_torque, "Torque at the sensor [N·m].")
      .def_readonly("excess", &Judgement::excess,
                    "Largest excess over a limit, as a share of the limit; 0: none.");
}

void bind_excitation(py::module_& m) {
  using Function = std::optional<py::function>;
  py::class_<Excitation>(m, "Excitation", "Judge motions and search for the best one.")
      .def(py::init([](const Family& family, const simulate::Scenario& scenario,
                       std::vector<Drawn> joints, const Held& held, Criterion criterion,
                       int window) {
             return Excitation(family, scenario, std::move(joints), held, criterion, window);
           }),
           py::kw_only(), py::arg("family"), py::arg("scenario"), py::arg("joints"),
           py::arg("held"), py::arg("criterion"), py::arg("window"))
      .def_property_readonly("joints", &Excitation::joints)
      .def_property_readonly(
          "genes", [](const Excitation& self) { return self.family().genes(); },
          "Number of genes that define a motion.")
      .def(
          "judge",
          [](const Excitation& self, const simulate::Trajectory& trajectory) {
            const py::gil_scoped_release nogil;
            base::Pool pool(1, SignalPoll{});
            std::vector<Judgement> found;
            pool.for_each(
                1, [&](std::size_t, std::size_t) { found = self.judge(trajectory, pool.cancel()); },
                1);
            return found;
          },
          py::arg("trajectory"), "Return one judgement per joint.")
      .def(
          "motion",
          [](const Excitation& self, const Eigen::VectorXd& genes) {
            const Sines sines = motion_of(self.family(), genes);
            py::dict arguments;
            arguments["amplitude"] = sines.amplitude;
            arguments["frequency"] = sines.frequency;
            arguments["phase"] = sines.phase;
            arguments["offset"] = sines.offset;
            arguments["fade"] = sines.fade;
            arguments["duration"] = sines.duration;
            return arguments;
          },
          py::arg("genes"), "Return the arguments of Trajectory.multisine.")
      .def(
          "leave_out",
          [](Excitation& self, const Eigen::MatrixXd& candidates, double largest, int threads) {
            const py::gil_scoped_release nogil;
            base::Pool pool(threads, SignalPoll{});
            self.leave_out(candidates, largest, pool);
          },
          py::arg("candidates"), py::kw_only(), py::arg("largest"), py::arg("threads") = 0,
          "Leave out, for each joint, the parameters that none of these motions determines to "
          "within `largest`.")
      .def(
          "search",
          [](const Excitation& self, const search::GaOptions& options, std::uint64_t seed,
             std::uint32_t trial, int threads, const Function& callback) {
            const py::gil_scoped_release nogil;
            base::Pool pool(threads, SignalPoll{});
            const search::Observer observer = [&](const search::Generation& generation) {
              if (!callback) return false;
              const py::gil_scoped_acquire gil;
              const py::object stop = (*callback)(generation);
              return !stop.is_none() && stop.cast<bool>();
            };
            return search::minimise_genetic(
                [&self](const Eigen::MatrixXd& candidates, Eigen::VectorXd& costs,
                        base::Pool& workers) { self.evaluate(candidates, costs, workers); },
                self.family().domain(), options, seed, trial, pool, observer);
          },
          py::kw_only(), py::arg("options"), py::arg("seed") = 0, py::arg("trial") = 0,
          py::arg("threads") = 0, py::arg("callback") = py::none(),
          "Genetic search for the motion with the smallest cost.");
}

}  // namespace

void bind_design(py::module_& m) {
  bind_values(m);
  bind_results(m);
  bind_excitation(m);
}

}  // namespace jointid::bind
