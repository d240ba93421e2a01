/* The registers of the guest's programs, preloaded into User Mode Linux: all that the host's
   processor has, whatever the kernel was built for.

   Linux 6.1 keeps some 2.7 kB of vector registers for each program and writes so many back. A host
   whose processor has more (AMX) refuses to set a part of them, and the guest's first program ends
   at once. What the kernel does not know is left as it is. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/uio.h>

#ifndef NT_X86_XSTATE
#define NT_X86_XSTATE 0x202
#endif

typedef long (*function)(enum __ptrace_request, ...);

long ptrace(enum __ptrace_request request, ...) {
  static function next;
  if (!next) next = (function)dlsym(RTLD_NEXT, "ptrace");
  va_list list;
  va_start(list, request);
  int const program = va_arg(list, int);
  void* const place = va_arg(list, void*);
  void* const data = va_arg(list, void*);
  va_end(list);
  if (request == PTRACE_SETREGSET && (long)place == NT_X86_XSTATE) {
    static char registers[1 << 16];
    struct iovec all = {registers, sizeof registers};
    struct iovec const* const known = data;
    if (next(PTRACE_GETREGSET, program, place, &all) == 0 && all.iov_len > known->iov_len) {
      memcpy(registers, known->iov_base, known->iov_len);
      return next(request, program, place, &all);
    }
  }
  return next(request, program, place, data);
}
