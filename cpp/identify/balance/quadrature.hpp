#pragma once
// Window integrals of the terms. Friction jumps where the velocity changes sign, so its integral is
// a weighted sum over nodes: the samples (trapezoidal rule) and, in an interval with a reversal,
// the zero crossing of the interpolated velocity.

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "base/cancel.hpp"
#include "identify/balance/friction_nodes.hpp"
#include "identify/balance/terms.hpp"
#include "identify/recording/recording.hpp"
#include "identify/recording/windows.hpp"

namespace jointid::identify {

/// One integral per window, for every term without a shape and for the torque. A harmonic of the
/// motor counts revolutions in front of the gear.
void integrate(const Term& term, double gear_ratio, const RecordingView& recording,
               const std::vector<std::uint8_t>& usable, std::span<const Window> windows,
               Eigen::Ref<Eigen::VectorXd> result);
void integrate_torque(const RecordingView& recording, const std::vector<std::uint8_t>& usable,
                      std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result);

/// Integral of the own term with this name, from the first sample to each sample. Throws
/// std::invalid_argument if the recording has none.
const RecordingView::Signal& own_series(const RecordingView& recording, const std::string& name);

/// Whether exp(-rate v^2) is 0 for all of these samples, at least one.
bool has_vanished(double rate, const double* velocity, std::size_t count);

/// Rise of the torque over each window's usable intervals.
void sum_torque_steps(const RecordingView& recording, const std::vector<std::uint8_t>& usable,
                      std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result);

/// Difference of Simpson's rule, with a velocity that is straight between samples, and the
/// trapezoidal rule for a friction term with shapes. It covers each window's usable intervals
/// without a reversal.
void integrate_bending(const Term& term, const Eigen::VectorXd& shapes,
                       const RecordingView& recording, const std::vector<std::uint8_t>& usable,
                       std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result);

/// The friction column of a term for these shapes. `cancel` is read once per block of nodes; it may
/// be null.
void integrate_friction(const Term& term, const FrictionNodes& nodes, const double* shapes,
                        const base::Cancel* cancel, Eigen::Ref<Eigen::VectorXd> column);

/// The same for a term with shapes, followed by its derivative by each shape: windows x (1 +
/// shapes).
void integrate_slopes(const Term& term, const FrictionNodes& nodes, const double* shapes,
                      const base::Cancel* cancel, Eigen::Ref<Eigen::MatrixXd> columns);

}  // namespace jointid::identify
