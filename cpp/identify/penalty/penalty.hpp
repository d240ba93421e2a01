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
/// that over sensor_gain. Parameters are ordered as `names()`: coefficients in the order given,
/// then shapes. A coefficient of `per_recording` is one a recording, "name[0]", "name[1]", ...
/// With cumulative windows r is the running sum of the windows' residuals, within each recording.
/// Load friction acts on that sum of terms, F, in each direction of motion: see load_friction.hpp.
class Penalty final : public PenaltyFunction {
 public:
  using Masked = std::vector<std::shared_ptr<const MaskedRecording>>;
  Penalty(std::vector<Recording> recordings, const std::vector<std::string>& terms,
          const WindowOptions& windows, Residual residual, bool mask_standstill,
          double gear_ratio = 1.0, const std::vector<std::string>& per_recording = {});
  /// The same from recordings whose mask is known; they are not kept. With a pool its workers
  /// integrate.
  Penalty(const Masked& recordings, const std::vector<std::string>& terms,
          const WindowOptions& windows, Residual residual, double gear_ratio = 1.0,
          const std::vector<std::string>& per_recording = {}, base::Pool* pool = nullptr);

  /// A term whose column depends on shapes.
  struct Shaped {
    Eigen::Index coefficient;
    std::vector<Eigen::Index> shapes;  ///< among the shapes
    Term term;
  };

  [[nodiscard]] const std::vector<std::string>& names() const override { return names_; }
  /// Of a stretch of a recording, on which nothing need be determined: few windows, even none, will
  /// do.
  static Penalty fragment(const Masked& recordings, const std::vector<std::string>& terms,
                          double window_duration, Residual residual, double gear_ratio);

  /// The term of each coefficient.
  [[nodiscard]] const std::vector<Term>& terms() const { return terms_; }
  [[nodiscard]] const std::vector<Shaped>& shaped() const { return shaped_; }
  /// Largest speed that a shaped column is summed over [rad/s or m/s].
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
  /// Residuals and columns with the reading itself, and the derivatives of the penalty's own
  /// residuals, in one pass; returns the penalty.
  double linearise(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                   Eigen::MatrixXd& jacobian, Eigen::MatrixXd& columns) const;
  void evaluate(const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                base::Pool& pool) const override;
  void columns(const Eigen::VectorXd& shapes, Eigen::MatrixXd& result,
               const base::Cancel* cancel = nullptr) const override;
  /// Replaces the gain's column by its first stage; `free` are the parameters that vary. Before
  /// that, the residual of instruments is that of the torque. Only with that residual.
  void project_reading(const std::vector<Eigen::Index>& free, base::Pool* pool = nullptr);
  void project_reading(const FirstStage& stage, base::Pool* pool = nullptr);
  /// Of the last project_reading, if any.
  [[nodiscard]] const std::optional<FirstStage>& first_stage() const { return first_stage_; }
  /// Integrals of the sensor's reading itself. Only with a gain.
  [[nodiscard]] Eigen::VectorXd reading() const;
  /// What may explain the reading where these parameters vary and there are so many windows.
  [[nodiscard]] Instruments instruments(const std::vector<Eigen::Index>& free,
                                        std::size_t windows) const;
  /// The instruments over some windows; of running sums, over all.
  [[nodiscard]] Eigen::MatrixXd instrument_rows(const Instruments& instruments,
                                                const Stretch& windows) const;
  /// Turns `residuals` into those with the reading itself, whose scatter is the estimate's; they
  /// are the same unless the reading is projected.
  void observe(const Eigen::VectorXd& theta, Eigen::VectorXd& residual) const;
  [[nodiscard]] bool is_linear() const override { return load_ < 0; }
  void linear_columns(const Eigen::VectorXd& shapes, const Eigen::VectorXd& about,
                      Eigen::MatrixXd& result, const base::Cancel* cancel = nullptr) const override;
  /// Integrals of the torque.
  [[nodiscard]] const Eigen::VectorXd& target() const override { return target_; }
  /// Columns without the shaped ones, which are zero here.
  [[nodiscard]] const Eigen::MatrixXd& constant_columns() const { return columns_; }
  /// What the shaped columns of a direction are sums over.
  [[nodiscard]] const FrictionNodes& nodes(model::Direction direction) const {
    return nodes_[static_cast<std::size_t>(direction)];
  }

  /// What was cut and why, one entry a window; sample numbers are within `recording_of`.
  [[nodiscard]] const std::vector<Window>& windows() const { return windows_; }
  /// First and last sample of each window, a row each.
  [[nodiscard]] Eigen::Matrix<std::int64_t, Eigen::Dynamic, 2> window_bounds() const;
  [[nodiscard]] const std::vector<int>& recording_of() const { return recording_of_; }
  /// With which each recording was cut [s].
  [[nodiscard]] const std::vector<double>& cut_durations() const { return cut_durations_; }
  /// How far the torque rises over each window's usable intervals; `recordings` are those it was
  /// cut from.
  [[nodiscard]] Eigen::VectorXd torque_steps(const Masked& recordings) const;
  /// What the windows' friction lacks because the trapezoid rule takes it as straight between
  /// samples.
  [[nodiscard]] Eigen::VectorXd bending(const Masked& recordings,
                                        const Eigen::VectorXd& theta) const;
  [[nodiscard]] const Eigen::VectorXd& usable_duration() const {
    return usable_duration_;
  }  ///< [s] a window
  [[nodiscard]] bool cumulative() const { return cumulative_; }
  [[nodiscard]] const WindowChoice& window_choice() const { return choice_; }
  [[nodiscard]] std::int64_t standing_samples() const { return standing_; }
  [[nodiscard]] std::int64_t unusable_intervals() const { return unusable_; }
  [[nodiscard]] std::int64_t total_samples() const { return total_; }

 private:
  void add_term(const std::string& key);
  /// Residuals, and where they are not null their derivatives and the columns.
  void balance(const Eigen::VectorXd& theta, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian,
               Eigen::MatrixXd* columns, const base::Cancel* cancel) const;
  friend class PenaltyParts;
  void weigh_link();
  /// Calls work(recording, its windows, the first of their rows) for each recording.
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
  /// The same, and behind it its derivatives by the term's shapes.
  void shaped_slopes(const Shaped& shaped, const double* shapes, const base::Cancel* cancel,
                     Eigen::MatrixXd& columns) const;
  /// All columns, not accumulated; of the intervals with negative velocity, or of all.
  void plain_columns(const double* shapes, bool backward, const base::Cancel* cancel,
                     Eigen::MatrixXd& result) const;
  void accumulate(Eigen::Ref<Eigen::VectorXd> values) const;
  void accumulate_all();
  void integrate_link(const RecordingView& recording, Eigen::Index first, Eigen::Index count);
  /// Window sums of the instruments' decays: by those of the samples where a window's nodes are its
  /// samples.
  void sum_decays(const FrictionNodes& nodes, const Stretch& windows,
                  const std::vector<double>& rates, Eigen::Ref<Eigen::MatrixXd> columns) const;
  /// Of (instruments, reading).
  [[nodiscard]] Eigen::MatrixXd instrument_triangle(const Instruments& instruments,
                                                    base::Pool* pool);
  [[nodiscard]] std::vector<Stretch> blocks() const;
  void divide_by_gain(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                      Eigen::MatrixXd* jacobian) const;
  /// Balance of the torque in both directions of motion, a row a window.
  struct Loaded {
    Eigen::MatrixXd all;   ///< plain columns
    Eigen::MatrixXd back;  ///< the part of them with negative velocity
    Eigen::VectorXd torque;
    Eigen::VectorXd by_load;
    Eigen::VectorXd by_share;
    Eigen::VectorXd weights;  ///< of the coefficients, in the torque behind the gear
    Eigen::MatrixXd gain;  ///< of the columns' forward and backward part, and of the link's in them
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
  std::vector<Eigen::MatrixXd> kept_rows_;  ///< instruments between the two stages, if few
  Eigen::VectorXd reading_;                 ///< the gain's column before its projection
  std::optional<FirstStage> first_stage_;
  double fastest_ = 0.0;                                     ///< in the whole recordings
  std::vector<std::shared_ptr<const SampleDecays>> decays_;  ///< of each recording, of instruments
  Eigen::Index runs_ = 0;
  std::array<FrictionNodes, 3> nodes_;  ///< by model::Direction, as far as needed
  Eigen::Index load_ = -1;              ///< load friction, among the shapes; -1 without it
  Eigen::MatrixXd backward_;      ///< of columns_, the part of intervals with negative velocity
  bool link_load_ = false;        ///< the load is the torque behind the gear, not the drive's
  Eigen::Index share_ = -1;       ///< the share of the inertia behind it, among the shapes
  Eigen::VectorXd link_weights_;  ///< of the coefficients, in the torque behind the gear
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
