#include "identify/solve/regression.hpp"

#include "bind/recording.hpp"

namespace jointid::bind {

void bind_regression(py::module_& m) {
  using Matrix = Eigen::Ref<const Eigen::MatrixXd>;
  constexpr std::int64_t kSamplesEach = 10;  // a row is a window
  m.def(
      "triangle",
      [](const Matrix& matrix, int threads) {
        const py::gil_scoped_release nogil;
        return with_pool(matrix.rows() * kSamplesEach, threads,
                         [&](base::Pool* pool) { return identify::triangle(matrix, pool); });
      },
      py::arg("matrix"), py::kw_only(), py::arg("threads") = 0,
      "R of the QR decomposition of a tall matrix.");
  m.def(
      "robust_variance",
      [](const Matrix& jacobian, const Eigen::VectorXd& residual, const Eigen::VectorXd& scale,
         const Eigen::MatrixXd& weights, int threads) {
        const py::gil_scoped_release nogil;
        return with_pool(jacobian.rows() * kSamplesEach, threads, [&](base::Pool* pool) {
          return identify::robust_variance(jacobian, residual, scale, weights, pool);
        });
      },
      py::arg("jacobian"), py::arg("residual"), py::arg("scale"), py::arg("weights"), py::kw_only(),
      py::arg("threads") = 0, "Prewhitened Newey-West variance of weighted sums of the scores.");
}

}  // namespace jointid::bind
