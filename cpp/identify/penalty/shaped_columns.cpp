// Columns that depend on shapes, and their derivatives.

#include <array>

#include "identify/penalty/penalty.hpp"

namespace jointid::identify {

namespace {

std::array<double, 4> shapes_of(const Penalty::Shaped& shaped, const double* shapes) {
  std::array<double, 4> own{};
  for (std::size_t i = 0; i < shaped.shapes.size(); ++i) own[i] = shapes[shaped.shapes[i]];
  return own;
}

}  // namespace

void Penalty::shaped_column(const Shaped& shaped, const double* shapes, const base::Cancel* cancel,
                            Eigen::Ref<Eigen::VectorXd> column) const {
  integrate_friction(shaped.term, nodes(shaped.term.direction), shapes_of(shaped, shapes).data(),
                     cancel, column);
  if (cumulative_) accumulate(column);
}

void Penalty::shaped_slopes(const Shaped& shaped, const double* shapes, const base::Cancel* cancel,
                            Eigen::MatrixXd& columns) const {
  columns.resize(window_count(), static_cast<Eigen::Index>(shaped.shapes.size()) + 1);
  integrate_slopes(shaped.term, nodes(shaped.term.direction), shapes_of(shaped, shapes).data(),
                   cancel, columns);
  if (!cumulative_) return;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) accumulate(columns.col(j));
}

}  // namespace jointid::identify
