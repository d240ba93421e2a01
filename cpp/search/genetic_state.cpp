#include "search/genetic_state.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "base/digits.hpp"
#include "base/input_error.hpp"

namespace jointid::search {

namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");

constexpr std::string_view kMagic = "jointid genetic search, format 1\n";

[[noreturn]] void refuse(const std::string& why) {
  throw base::InputError(why, "checkpoint of a genetic search");
}

std::uint64_t checksum(std::string_view bytes) {  // FNV-1a
  std::uint64_t sum = 14695981039346656037U;
  for (const char byte : bytes) {
    sum = (sum ^ static_cast<unsigned char>(byte)) * 1099511628211U;
  }
  return sum;
}

class Writer {
 public:
  std::string bytes{kMagic};

  template <class T>
  void operator()(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
  }
  template <class Numbers>
  void all(const Numbers& numbers) {
    (*this)(static_cast<std::uint64_t>(numbers.size()));
    for (Eigen::Index i = 0; i < numbers.size(); ++i) (*this)(numbers.data()[i]);
  }
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  void operator()(T& value) {
    if (rest_.size() < sizeof(T)) refuse("it is cut off");
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
  }
  Eigen::VectorXd all() {
    std::uint64_t count = 0;
    (*this)(count);
    if (count > rest_.size() / sizeof(double)) refuse("it is cut off");
    Eigen::VectorXd numbers(static_cast<Eigen::Index>(count));
    for (double& number : numbers) (*this)(number);
    return numbers;
  }
  [[nodiscard]] bool done() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

/// Writes every kind of field (flag, count, choice, number) exactly, as a number.
template <class Field>
double number_of(const Field& field) {
  return static_cast<double>(field);
}

template <class Field>
void tell(Field& field, double number) {
  if constexpr (std::is_enum_v<Field>) {
    if (!(number >= 0.0 && number < static_cast<double>(base::Words<Field>::all.size()))) {
      refuse("an option has an unknown value");
    }
    field = static_cast<Field>(static_cast<int>(number));
  } else if constexpr (std::is_same_v<Field, int>) {
    if (!(std::fabs(number) <= std::numeric_limits<int>::max())) refuse("an option is too large");
    field = static_cast<int>(number);
  } else if constexpr (std::is_same_v<Field, bool>) {
    field = number != 0.0;
  } else {
    field = number;
  }
}

template <class Run, class Generation>
void generation_fields(Run& run, Generation& g) {
  run(g.number);
  run(g.best);
  run(g.mean);
  run(g.diversity);
  run(g.crossover_probability);
  run(g.mutation_probability);
  run(g.evaluations);
}

void require_whole(const GaState& s) {
  s.options.validate();
  s.domain.validate();
  const auto individuals = static_cast<Eigen::Index>(s.options.population) *
                           static_cast<Eigen::Index>(s.options.islands);
  const bool sizes = s.penalties.size() == individuals && s.genes.cols() == individuals &&
                     s.best.size() == s.domain.size() &&
                     s.genes.rows() == static_cast<Eigen::Index>(s.domain.free().size());
  const bool values = s.generation >= 0 && s.generation <= s.options.generations &&
                      s.history.size() == static_cast<std::size_t>(s.generation) + 1 &&
                      (s.genes.array() >= 0.0).all() && (s.genes.array() <= 1.0).all() &&
                      !s.penalties.hasNaN();
  if (!sizes || !values) refuse("its parts do not fit together");
}

template <class Number>
std::string difference(const std::string& what, Number then, Number now) {
  const auto shown = [](Number number) {
    if constexpr (std::is_floating_point_v<Number>) {
      return base::with_digits(number, 17);
    } else if constexpr (std::is_integral_v<Number>) {
      return std::to_string(number);
    } else {
      return std::string(number);
    }
  };
  return "resume: the state was made with " + what + " " + shown(then) + ", not " + shown(now);
}

}  // namespace

std::string to_bytes(const GaState& s) {
  Writer write;
  each_field(s.options, [&](const char*, const auto& field) { write(number_of(field)); });
  write(s.seed);
  write(s.trial);
  write.all(s.domain.lower);
  write.all(s.domain.upper);
  write(s.generation);
  write.all(s.genes);
  write.all(s.penalties);
  write.all(s.best);
  write(s.penalty);
  write(s.evaluations);
  write(static_cast<std::uint64_t>(s.history.size()));
  for (const auto& generation : s.history) generation_fields(write, generation);
  write(checksum(write.bytes));
  return write.bytes;
}

GaState state_from_bytes(std::string_view bytes) {
  if (!bytes.starts_with(kMagic))
    refuse("this is not a checkpoint file, or one of another version");
  if (bytes.size() < kMagic.size() + sizeof(std::uint64_t)) refuse("it is cut off");
  const std::string_view body = bytes.substr(0, bytes.size() - sizeof(std::uint64_t));
  std::uint64_t sum = 0;
  Reader(bytes.substr(body.size()))(sum);
  if (sum != checksum(body)) refuse("it is damaged or cut off (its checksum differs)");
  Reader read(body.substr(kMagic.size()));
  GaState s;
  each_field(s.options, [&](const char*, auto& field) {
    double number = 0.0;
    read(number);
    tell(field, number);
  });
  read(s.seed);
  read(s.trial);
  s.domain.lower = read.all();
  s.domain.upper = read.all();
  read(s.generation);
  const Eigen::VectorXd genes = read.all();
  s.penalties = read.all();
  if (s.penalties.size() == 0 || genes.size() % s.penalties.size() != 0) {
    refuse("its parts do not fit together");
  }
  s.genes = genes.reshaped(genes.size() / s.penalties.size(), s.penalties.size());
  s.best = read.all();
  read(s.penalty);
  read(s.evaluations);
  std::uint64_t generations = 0;
  read(generations);
  for (std::uint64_t i = 0; i < generations; ++i) generation_fields(read, s.history.emplace_back());
  if (!read.done()) refuse("something follows its end");
  require_whole(s);
  return s;
}

void require_same_run(const GaState& state, const GaOptions& options, const Domain& domain,
                      std::uint64_t seed, std::uint32_t trial) {
  require_whole(state);
  std::vector<std::pair<const char*, double>> now;
  each_field(options, [&](const char* name, const auto& field) {
    now.emplace_back(name, number_of(field));
  });
  std::size_t next = 0;
  each_field(state.options, [&](const char* name, const auto& field) {
    const double other = now[next++].second;
    if (number_of(field) == other) return;
    using Field = std::remove_cvref_t<decltype(field)>;
    if constexpr (std::is_enum_v<Field>) {
      const auto given = static_cast<Field>(static_cast<int>(other));
      throw base::InputError(difference(name, base::word(field), base::word(given)));
    } else {
      throw base::InputError(difference(name, number_of(field), other));
    }
  });
  if (state.seed != seed) throw base::InputError(difference("seed", state.seed, seed));
  if (state.trial != trial) throw base::InputError(difference("trial", state.trial, trial));
  if (state.domain.size() != domain.size()) {
    throw base::InputError(
        difference("a number of parameters of", state.domain.size(), domain.size()));
  }
  for (Eigen::Index i = 0; i < domain.size(); ++i) {
    const std::string which = "bound of parameter " + std::to_string(i);
    if (state.domain.lower[i] != domain.lower[i]) {
      throw base::InputError(difference("lower " + which, state.domain.lower[i], domain.lower[i]));
    }
    if (state.domain.upper[i] != domain.upper[i]) {
      throw base::InputError(difference("upper " + which, state.domain.upper[i], domain.upper[i]));
    }
  }
}

}  // namespace jointid::search
