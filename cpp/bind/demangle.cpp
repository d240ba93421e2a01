// In place of libc++abi's demangler, a twentieth of the compiled part where that library is linked
// in. pybind11 asks for names of C++ types that Python does not know, and a program that dies of an
// exception for the exception's: both show the name as the compiler writes it.

#include <cstddef>

extern "C" __attribute__((visibility("hidden"))) char* __cxa_demangle(const char* /*name*/,
                                                                      char* /*buffer*/,
                                                                      std::size_t* /*length*/,
                                                                      int* status) {
  constexpr int kNoName = -2;
  if (status != nullptr) *status = kNoName;
  return nullptr;
}
