#include "bind/bind.hpp"

PYBIND11_MODULE(_core, m, pybind11::mod_gil_not_used()) {
  // Eigen divides products into blocks that fit the caches. Fixed sizes give the same bits on every
  // host.
  Eigen::setCpuCacheSizes(32 << 10, 1 << 20, 8 << 20);
  m.doc() = "The compiled core of jointid; use it through the package jointid.";
  m.attr("__version__") = JOINTID_VERSION;
#if defined(__x86_64__) && defined(JOINTID_ZIG)
  // Features by which a clone is chosen when the extension is loaded; tools/wheels.sh checks them.
  __builtin_cpu_init();
  m.attr("__avx2__") = __builtin_cpu_supports("avx2") != 0;
#endif
  jointid::bind::bind_input_error();
  jointid::bind::bind_distributions(m);
  jointid::bind::bind_terms(m);
  jointid::bind::bind_recording(m);
  jointid::bind::bind_penalty(m);
  jointid::bind::bind_search(m);
  jointid::bind::bind_online(m);
  jointid::bind::bind_signals(m);
  jointid::bind::bind_shifts(m);
  jointid::bind::bind_diagnose(m);
  jointid::bind::bind_regression(m);
  jointid::bind::bind_simulate(m);
  jointid::bind::bind_text(m);
  jointid::bind::bind_design(m);
}
