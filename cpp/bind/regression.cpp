#include "identify/solve/regression.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "bind/recording.hpp"
#include "identify/solve/covariance.hpp"
#include "identify/solve/folds.hpp"
#include "identify/solve/motion_cuts.hpp"
#include "search/least_squares.hpp"

namespace jointid::bind {

void bind_regression(py::module_& m) {
  using Matrix = Eigen::Ref<const Eigen::MatrixXd>;
  using Rows = py::array_t<double, py::array::c_style | py::array::forcecast>;
  constexpr std::int64_t kSamplesEach = 10;  // a row is a window
  m.def(
      "triangle",
      [](const Matrix& matrix, int threads) {
        const py::gil_scoped_release nogil;
        return with_pool(matrix.rows() * kSamplesEach, threads,
                         [&](base::Pool* pool) { return identify::triangle(matrix, pool); });
      },
      py::arg("matrix"), py::kw_only(), py::arg("threads") = 0,
      "Return R of the QR decomposition of a tall matrix.");
  m.def(
      "box_minima",
      [](const Rows& square, const Rows& gradient, const Eigen::VectorXd& lower,
         const Eigen::VectorXd& upper) {
        const py::ssize_t n = lower.size();
        if (gradient.ndim() != 2 || square.ndim() != 3 || gradient.shape(1) != n ||
            square.shape(0) != gradient.shape(0) || square.shape(1) != n || square.shape(2) != n ||
            upper.size() != n) {
          throw std::invalid_argument("square, gradient and bounds must fit together");
        }
        Rows found({gradient.shape(0), n});
        double* const to = found.mutable_data();
        const py::gil_scoped_release nogil;
        for (py::ssize_t i = 0; i < gradient.shape(0); ++i) {
          const Eigen::Map<const Eigen::MatrixXd> own(square.data() + i * n * n, n, n);
          const Eigen::Map<const Eigen::VectorXd> slope(gradient.data() + i * n, n);
          Eigen::Map<Eigen::VectorXd>(to + i * n, n) =
              search::box_minimum(own, slope, lower, upper);
        }
        return found;
      },
      py::arg("square"), py::arg("gradient"), py::arg("lower"), py::arg("upper"),
      "Return the minima of quadratic functions inside a box: (n, p, p) and (n, p) to (n, p).");
  m.def(
      "solve_independent",
      [](const Matrix& triangle, const std::vector<Eigen::Index>& columns, Eigen::Index target) {
        const auto outside = [&](Eigen::Index j) { return j < 0 || j >= triangle.cols(); };
        if (outside(target) || std::any_of(columns.begin(), columns.end(), outside)) {
          throw std::invalid_argument("the triangle has no such column");
        }
        return identify::solve_independent(triangle, columns, target);
      },
      py::arg("triangle"), py::arg("columns"), py::arg("target"),
      "Return the coefficients of columns for the target column, and the norm of the remainder. "
      "None unless the columns are clearly independent.");
  using identify::Cuts;
  m.def(
      "covariance",
      [](const Matrix& jacobian, const Eigen::VectorXd& residual, const Eigen::MatrixXd& triangle,
         const Cuts& cuts, std::optional<std::tuple<Eigen::Index, Eigen::Index, double>> centre) {
        const auto unfit = [&](const std::vector<std::int64_t>& each) {
          return each.size() < 2 || !std::is_sorted(each.begin(), each.end()) || each.front() < 0 ||
                 each.back() > jacobian.rows();
        };
        const auto outside = [&](Eigen::Index column) {
          return column < 0 || column >= triangle.cols();
        };
        std::optional<identify::Centre> about;
        if (centre) about = std::make_from_tuple<identify::Centre>(*centre);
        if (std::any_of(cuts.begin(), cuts.end(), unfit) || cuts.empty() ||
            residual.size() != jacobian.rows() || triangle.cols() != jacobian.cols() ||
            triangle.size() == 0 || (about && (outside(about->gain) || outside(about->offset)))) {
          throw std::invalid_argument("residual, triangle, cuts and centre must fit the Jacobian");
        }
        identify::Covariance found;
        {
          const py::gil_scoped_release nogil;
          found = identify::covariance_of(jacobian, residual, triangle, cuts, about);
        }
        return std::make_tuple(std::move(found.matrix), std::move(found.information),
                               std::move(found.stderr_), std::move(found.freedom), found.white,
                               std::move(found.correlation), found.condition,
                               std::move(found.weakest));
      },
      py::arg("jacobian"), py::arg("residual"), py::arg("triangle"), py::arg("cuts"),
      py::arg("centre"), "Return the fields of a `Covariance`, in their order.");
  using Series = Eigen::Ref<const Eigen::VectorXd>;
  m.def(
      "motion_cuts",
      [](const Series& start, const Series& stop, const Series& travel,
         const std::vector<Eigen::Index>& edges, double length) {
        if (stop.size() != start.size() || travel.size() != start.size() || edges.empty() ||
            !std::is_sorted(edges.begin(), edges.end(), std::less_equal<>()) || edges.front() < 0 ||
            edges.back() > start.size() || !(length > 0.0)) {
          throw std::invalid_argument("edges must divide the windows into recordings");
        }
        const identify::MovingWindows windows{start, stop, travel};
        std::vector<std::int64_t> cuts{edges.front()};
        for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
          const auto own = identify::motion_cuts(windows, edges[i], edges[i + 1], length);
          cuts.insert(cuts.end(), own.begin(), own.end());
        }
        return cuts;
      },
      py::arg("start"), py::arg("stop"), py::arg("travel"), py::arg("edges"), py::arg("length"),
      "Return the first windows of the segments of motion, and the end of the last segment. "
      "`edges` are the first windows of the recordings, and the end of the last recording.");
  py::class_<identify::Folds>(m, "Folds",
                              "Cross-validated least squares on any subset of many columns.")
      .def(py::init([](const Rows& rows, const std::vector<std::int64_t>& edges) {
             if (rows.ndim() != 2 || rows.shape(1) < 1 || edges.size() < 2 ||
                 !std::is_sorted(edges.begin(), edges.end()) || edges.front() < 0 ||
                 edges.back() > rows.shape(0)) {
               throw std::invalid_argument("edges must cut the rows of a matrix into blocks");
             }
             return identify::Folds(rows.data(), static_cast<std::size_t>(rows.shape(1)), edges);
           }),
           py::arg("rows"), py::arg("edges"), "The last column is the target.")
      .def("misfit", &identify::Folds::misfit, py::arg("columns"),

           "Return the sum of squared residuals of each block, with these columns fitted to the "
           "other blocks.");
}

}  // namespace jointid::bind
