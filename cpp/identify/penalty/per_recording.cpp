#include <algorithm>
#include <utility>

#include "base/input_error.hpp"
#include "identify/penalty/penalty.hpp"

// Coefficients with one value per recording.

namespace jointid::identify {

void Penalty::own_columns(const std::vector<std::string>& per_recording, std::size_t recordings) {
  if (recordings < 2) return;
  for (const auto& name : per_recording) {
    const auto found = std::find_if(terms_.begin(), terms_.end(),
                                    [&](const Term& term) { return term.name == name; });
    if (found == terms_.end()) {
      throw base::InputError("'" + name + "' is not a coefficient of the model", "per_recording");
    }
    if (!found->shapes.empty() || found->integral == Integral::sensor) {
      throw base::InputError("'" + name + "' must be the same in all recordings", "per_recording");
    }
    const auto at = static_cast<Eigen::Index>(found - terms_.begin());
    const auto extra = static_cast<Eigen::Index>(recordings) - 1;
    const auto widen = [&](Eigen::MatrixXd& columns) {
      const Eigen::Index old = columns.cols();
      Eigen::MatrixXd wider = Eigen::MatrixXd::Zero(columns.rows(), old + extra);
      wider.leftCols(at) = columns.leftCols(at);
      wider.rightCols(old - at - 1) = columns.rightCols(old - at - 1);
      for (Eigen::Index row = 0; row < columns.rows(); ++row) {
        wider(row, at + recording_of_[static_cast<std::size_t>(row)]) = columns(row, at);
      }
      columns = std::move(wider);
    };
    widen(columns_);
    if (load_ >= 0) widen(backward_);
    const Term term = *found;
    terms_.insert(terms_.begin() + at, static_cast<std::size_t>(extra), term);
    names_.insert(names_.begin() + at, static_cast<std::size_t>(extra), name);
    for (std::size_t i = 0; i < recordings; ++i) {
      names_[static_cast<std::size_t>(at) + i] = name + "[" + std::to_string(i) + "]";
    }
    if (gain_index_ > at) gain_index_ += extra;
    for (auto& shaped : shaped_) {
      if (shaped.coefficient > at) shaped.coefficient += extra;
    }
  }
}

}  // namespace jointid::identify
