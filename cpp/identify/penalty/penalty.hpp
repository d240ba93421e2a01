#pragma once
// The integral penalty [4-21 .. 4-24]: the sum of squared window residuals, summed directly over
// the samples. All coefficients are linear; only shape parameters cost a pass over the samples.

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "identify/balance/decays.hpp"
#include "identify/balance/quadrature.hpp"
#include "identify/penalty/instruments.hpp"
#include "identify/penalty/penalty_function.hpp"

namespace jointid::identify {

/// Penalty of a parameter vector over one or several recordings.
///
/// P(theta) = sum over windows of r^2;  torque: r = integral(tau) - sum_j c_j phi_j(shape); sensor:
/// that over sensor_gain. Parameters are ordered as `names()`: coefficients in the order of the
/// terms, then shapes. A coefficient of `per_recording` has one value per recording, "name[0]",
/// "name[1]", ...
/// With cumulative windows r is the running sum of the windows' residuals, within each recording.
/// Load friction acts on that sum of terms, F, in each direction of motion: see load_friction.hpp.
class Penalty final : public PenaltyFunction {
 public:
  using Masked = std::vector<std::shared_ptr<const MaskedRecording>>;
  Penalty(std::vector<Recording> recordings, const std::vector<std::string>& terms,
          const WindowOptions& windows, Residual residual, bool mask_standstill,
          double gear_ratio = 1.0, const std::vector<std::string>& per_recording = {});
  /// The same from recordings with known masks, which are not kept. With a pool, its workers
  /// integrate.
  Penalty(const Masked& recordings, const std::vector<std::string>& terms,
          const WindowOptions& windows, Residual residual, double gear_ratio = 1.0,
          const std::vector<std::string>& per_recording = {}, base::Pool* pool = nullptr);

  /// A term with a column that depends on shapes.
  struct Shaped {
    Eigen::Index coefficient;
    std::vector<Eigen::Index> shapes;  ///< indices among the shapes
    Term term;
  };

  [[nodiscard]] const std::vector<std::string>& names() const override { return names_; }
  /// The penalty of a stretch of a recording. It need not determine the parameters, so it may have
  /// few windows or none.
  static Penalty fragment(const Masked& recordings, const std::vector<std::string>& terms,
                          double window_duration, Residual residual, double gear_ratio);

  /// The term of each coefficient.
  [[nodiscard]] const std::vector<Term>& terms() const { return terms_; }
  [[nodiscard]] const std::vector<Shaped>& shaped() const { return shaped_; }
  /// Largest speed over which a shaped column is summed [rad/s or m/s].
  [[nodiscard]] double peak_speed() const;
  [[nodiscard]] bool is_shaped(Eigen::Index coefficient) const;
  [[nodiscard]] Eigen::Index coefficients() const override { return columns_.cols(); }
  [[nodiscard]] Eigen::Index window_count() const { return target_.size(); }
  [[nodiscard]] Residual residual() const override { return residual_; }
  [[nodiscard]] Eigen::Index gain_index() const override { return gain_index_; }
  [[nodiscard]] bool is_cheap() const override { return false; }

  double operator()(const Eigen::VectorXd& theta,
                    const base::Cancel* cancel = nullptr) const override;
  void residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian,
                 const base::Cancel* cancel = nullptr) const override;
  /// Computes, in one pass, residuals and columns with the reading itself, and the derivatives of
  /// the penalty's own residuals. Returns the penalty.
  double linearise(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                   Eigen::MatrixXd& jacobian, Eigen::MatrixXd& columns) const;
  void evaluate(const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                base::Pool& pool) const override;
  void columns(const Eigen::VectorXd& shapes, Eigen::MatrixXd& result,
               const base::Cancel* cancel = nullptr) const override;
  /// Replaces the gain's column by its first stage; `free` are the free parameters. Only with the
  /// residual 'instruments', which is the residual of the torque until then.
  void project_reading(const std::vector<Eigen::Index>& free, base::Pool* pool = nullptr);
  void project_reading(const FirstStage& stage, base::Pool* pool = nullptr);
  /// The first stage of the last project_reading, if any.
  [[nodiscard]] const std::optional<FirstStage>& first_stage() const { return first_stage_; }
  /// Integrals of the sensor's reading itself. Only with a gain.
  [[nodiscard]] Eigen::VectorXd reading() const;
  /// The columns that may explain the reading with these free parameters and this number of
  /// windows.
  [[nodiscard]] Instruments instruments(const std::vector<Eigen::Index>& free,
                                        std::size_t windows) const;
  /// The instruments over some windows; for running sums, over all.
  [[nodiscard]] Eigen::MatrixXd instrument_rows(const Instruments& instruments,
                                                const Stretch& windows) const;
  /// Turns `residual` into the residual with the reading itself, which gives the scatter of the
  /// estimate. Changes nothing unless the reading is projected.
  void observe(const Eigen::VectorXd& theta, Eigen::VectorXd& residual) const;
  [[nodiscard]] bool is_linear() const override { return load_ < 0; }
  void linear_columns(const Eigen::VectorXd& shapes, const Eigen::VectorXd& about,
                      Eigen::MatrixXd& result, const base::Cancel* cancel = nullptr) const override;
  /// Integrals of the torque.
  [[nodiscard]] const Eigen::VectorXd& target() const override { return target_; }
  /// The constant columns; the shaped ones are zero here.
  [[nodiscard]] const Eigen::MatrixXd& constant_columns() const { return columns_; }
  /// The nodes over which the shaped columns of a direction are sums.
  [[nodiscard]] const FrictionNodes& nodes(model::Direction direction) const {
    return nodes_[static_cast<std::size_t>(direction)];
  }

  /// The windows; sample numbers count within the recording in `recording_of`.
  [[nodiscard]] const std::vector<Window>& windows() const { return windows_; }
  /// First and last sample of each window, one row each.
  [[nodiscard]] Eigen::Matrix<std::int64_t, Eigen::Dynamic, 2> window_bounds() const;
  [[nodiscard]] const std::vector<int>& recording_of() const { return recording_of_; }
  /// Window duration of each recording [s].
  [[nodiscard]] const std::vector<double>& cut_durations() const { return cut_durations_; }
  /// Rise of the torque over each window's usable intervals; `recordings` are those of this
  /// penalty.
  [[nodiscard]] Eigen::VectorXd torque_steps(const Masked& recordings) const;
  /// The window integrals of friction that the trapezoidal rule misses, because it takes friction
  /// as straight between samples.
  [[nodiscard]] Eigen::VectorXd bending(const Masked& recordings,
                                        const Eigen::VectorXd& theta) const;
  [[nodiscard]] const Eigen::VectorXd& usable_duration() const {
    return usable_duration_;
  }  ///< [s] per window
  [[nodiscard]] bool cumulative() const { return cumulative_; }
  [[nodiscard]] const WindowChoice& window_choice() const { return choice_; }
  [[nodiscard]] std::int64_t standing_samples() const { return standing_; }
  [[nodiscard]] std::int64_t unusable_intervals() const { return unusable_; }
  [[nodiscard]] std::int64_t total_samples() const { return total_; }

 private:
  void add_term(const std::string& key);
  /// Residuals and, if not null, their derivatives and the columns.
  void balance(const Eigen::VectorXd& theta, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian,
               Eigen::MatrixXd* columns, const base::Cancel* cancel) const;
  friend class PenaltyParts;
  void weigh_link();
  /// Calls work(recording, its windows, the first row) for each recording.
  template <class Work>
  void each_recording(const Masked& recordings, Work work) const;
  Penalty(const Masked& recordings, const std::vector<std::string>& terms, Residual residual,
          double gear_ratio);  ///< terms only; no windows yet
  void cut(const Masked& recordings, WindowOptions options);
  void integrate_all(const Masked& recordings, double gear_ratio, base::Pool* pool);
  void collect_nodes(const Masked& recordings, const base::Cancel* cancel, bool backward);
  void own_columns(const std::vector<std::string>& per_recording, std::size_t recordings);
  /// A shaped term's column.
  void shaped_column(const Shaped& shaped, const double* shapes, const base::Cancel* cancel,
                     Eigen::Ref<Eigen::VectorXd> column) const;
  /// The same, followed by its derivatives by the term's shapes.
  void shaped_slopes(const Shaped& shaped, const double* shapes, const base::Cancel* cancel,
                     Eigen::MatrixXd& columns) const;
  /// All columns, not accumulated, either over the intervals with negative velocity or over all.
  void plain_columns(const double* shapes, bool backward, const base::Cancel* cancel,
                     Eigen::MatrixXd& result) const;
  void accumulate(Eigen::Ref<Eigen::VectorXd> values) const;
  void accumulate_all();
  void integrate_link(const RecordingView& recording, Eigen::Index first, Eigen::Index count);
  /// Window sums of the instruments' decays. Where a window's nodes are its samples, the stored
  /// decays of the samples are summed.
  void sum_decays(const FrictionNodes& nodes, const Stretch& windows,
                  const std::vector<double>& rates, Eigen::Ref<Eigen::MatrixXd> columns) const;
  /// Triangle of (instruments, reading).
  [[nodiscard]] Eigen::MatrixXd instrument_triangle(const Instruments& instruments,
                                                    base::Pool* pool);
  [[nodiscard]] std::vector<Stretch> blocks() const;
  void divide_by_gain(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                      Eigen::MatrixXd* jacobian) const;
  /// Balance of the torque in both directions of motion, one row per window.
  struct Loaded {
    Eigen::MatrixXd all;   ///< plain columns
    Eigen::MatrixXd back;  ///< their part from intervals with negative velocity
    Eigen::VectorXd torque;
    Eigen::VectorXd by_load;
    Eigen::VectorXd by_share;
    Eigen::VectorXd weights;  ///< weights of the coefficients in the torque behind the gear
    Eigen::MatrixXd
        gain;  ///< gain of the columns' forward and backward part, and of the link's part in them
    /// A column's derivative from its parts; `weight` is its share in the link's torque.
    [[nodiscard]] Eigen::VectorXd slope(const Eigen::VectorXd& every, const Eigen::VectorXd& part,
                                        double weight) const;
  };
  [[nodiscard]] Loaded loaded(const double* shapes, const Eigen::VectorXd& coefficients,
                              const base::Cancel* cancel) const;
  void loaded_residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                        Eigen::MatrixXd* jacobian, const base::Cancel* cancel) const;

  std::vector<std::string> names_;  ///< coefficients, then shapes
  std::vector<Term> terms_;
  std::vector<Shaped> shaped_;
  bool cumulative_ = false;
  Residual residual_;
  Eigen::Index gain_index_ = -1;
  Eigen::MatrixXd columns_;  ///< windows x coefficients; shaped ones stay zero here
  Eigen::VectorXd target_;
  Eigen::MatrixXd link_;  ///< windows x (cosine, sine, duration, velocity change), for instruments
  std::vector<Eigen::MatrixXd>
      kept_rows_;            ///< instruments between the two stages, if there are few
  Eigen::VectorXd reading_;  ///< the gain's column before its projection
  std::optional<FirstStage> first_stage_;
  double fastest_ = 0.0;  ///< largest speed in the whole recordings
  std::vector<std::shared_ptr<const SampleDecays>> decays_;  ///< of each recording, for instruments
  Eigen::Index runs_ = 0;
  std::array<FrictionNodes, 3> nodes_;  ///< by model::Direction, as far as needed
  Eigen::Index load_ = -1;              ///< index of load friction among the shapes; -1 without it
  Eigen::MatrixXd backward_;            ///< part of columns_ from intervals with negative velocity
  bool link_load_ = false;   ///< the load is the torque behind the gear, not the drive's torque
  Eigen::Index share_ = -1;  ///< index of the share of the inertia behind the gear among the shapes
  Eigen::VectorXd link_weights_;  ///< weights of the coefficients in the torque behind the gear
  std::array<FrictionNodes, 3> backward_nodes_;
  std::vector<Window> windows_;
  std::vector<int> recording_of_;
  Eigen::VectorXd usable_duration_;
  WindowChoice choice_;
  std::vector<double> cut_durations_;
  std::int64_t standing_ = 0;
  std::int64_t unusable_ = 0;
  std::int64_t total_ = 0;
};

}  // namespace jointid::identify
