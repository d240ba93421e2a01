// Before the C library: the n-th call that changes files in one folder fails, or the power does (disk.c). Functions that
// would change them and that nothing here counts end the program: no call is missed.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include "disk.h"

enum { kPower = 0, kPart = -1 };  // instead of an error's number: the power fails; a part is written, without an error
enum { kGrows = 1, kIsRepeated = 2, kWrites = 4 };  // what a call does: asks for space; may be interrupted; takes a part
static atomic_long calls, injected;
static long fails_at;
static int kind, lasts;

// Counts the calls in `where`; the one with the number `at` (from 1; 0: none) fails so. `lasting`: those after it do, too.
void arm(const char* where, long at, int number, int lasting) {
  disk_begin(where);
  calls = injected = 0;
  fails_at = at;
  kind = number;
  lasts = lasting;
}

long counted(void) { return calls; }
long failed(void) { return injected; }
void lose(void) { disk_lose(); }

// What this call gets: 0, an error's number, or kPart.
static int fault(int does) {
  const long call = ++calls;
  if (!fails_at || call < fails_at) return 0;
  if (call == fails_at && kind == kPower) disk_lose();
  if (call > fails_at && !(lasts && (kind == EIO || does & kGrows))) return 0;  // a full disk still removes and renames
  if (kind == EINTR && !(does & kIsRepeated)) return 0;
  if (kind == kPart && !(does & kWrites)) return 0;
  ++injected;
  return kind;
}

static int fails(int does) {
  const int number = fault(does);
  if (number > 0) errno = number;
  return number > 0;
}

static int mine(int file) {
  char path[PATH_MAX];
  return disk_file(file, path);
}

static int to_write(int file) { return mine(file) && (fcntl(file, F_GETFL) & O_ACCMODE) != O_RDONLY; }

ssize_t write(int file, const void* data, size_t size) {
  if (mine(file)) {
    if (disk_replaces(file)) disk_give_up("bytes that are on the disk are replaced: that is not followed");
    const int number = fault(kGrows | kIsRepeated | (size > 1 ? kWrites : 0));
    if (number == kPart) return syscall(SYS_write, file, data, size / 2);
    if (number) {
      if (size > 1 && number != EINTR && syscall(SYS_write, file, data, size / 2) < 0) return -1;  // a full disk takes a part
      errno = number;
      return -1;
    }
  }
  return syscall(SYS_write, file, data, size);
}

#define SYNC(name)                                         \
  int name(int file) {                                     \
    if (!mine(file)) return (int)syscall(SYS_##name, file); \
    if (fails(kIsRepeated)) return -1;                     \
    disk_synced(file);                                     \
    return 0;                                              \
  }
SYNC(fsync)
SYNC(fdatasync)

// Network file systems say here what they could not write.
int close(int file) {
  const int failing = to_write(file) && fails(0);
  const int number = errno;
  disk_closing(file);
  const int done = (int)syscall(SYS_close, file);
  if (failing) errno = number;
  return failing ? -1 : done;
}

#define CUT(name)                                          \
  int name(int file, off_t size) {                         \
    if (mine(file)) {                                      \
      if (fails(kIsRepeated)) return -1;                   \
      disk_cut(file, size);                                \
    }                                                      \
    return (int)syscall(SYS_ftruncate, file, size);        \
  }
CUT(ftruncate)
CUT(ftruncate64)

static int move_at(int place, const char* from, int other, const char* to, unsigned flags) {
  char old[PATH_MAX], new[PATH_MAX];
  if (!disk_path(other, to, new) || flags) return (int)syscall(SYS_renameat2, place, from, other, to, flags);
  if (!disk_path(place, from, old)) disk_give_up("moved into the folder");
  return fails(0) ? -1 : disk_move(old, new);
}
int rename(const char* from, const char* to) { return move_at(AT_FDCWD, from, AT_FDCWD, to, 0); }
int renameat(int place, const char* from, int other, const char* to) { return move_at(place, from, other, to, 0); }
int renameat2(int place, const char* from, int other, const char* to, unsigned flags) {
  return move_at(place, from, other, to, flags);
}

int linkat(int place, const char* from, int other, const char* to, int flags) {
  char new[PATH_MAX];
  const int in = disk_path(other, to, new);
  if (in && fails(kGrows)) return -1;
  const int done = (int)syscall(SYS_linkat, place, from, other, to, flags);
  if (in && !done) disk_made(new);
  return done;
}
int link(const char* from, const char* to) { return linkat(AT_FDCWD, from, AT_FDCWD, to, 0); }

int mkdirat(int place, const char* path, mode_t mode) {
  char whole[PATH_MAX];
  const int in = disk_path(place, path, whole);
  if (in && fails(kGrows)) return -1;
  const int done = (int)syscall(SYS_mkdirat, place, path, mode);
  if (in && !done) disk_made(whole);
  return done;
}
int mkdir(const char* path, mode_t mode) { return mkdirat(AT_FDCWD, path, mode); }

int fchmodat(int place, const char* path, mode_t mode, int flags) {
  char whole[PATH_MAX];
  if (disk_path(place, path, whole) && fails(0)) return -1;
  (void)flags;
  return (int)syscall(SYS_fchmodat, place, path, mode);
}
int chmod(const char* path, mode_t mode) { return fchmodat(AT_FDCWD, path, mode, 0); }
int fchmod(int file, mode_t mode) {
  if (mine(file) && fails(0)) return -1;
  return (int)syscall(SYS_fchmod, file, mode);
}

// Not counted, since nothing is lost where it fails; but a disk that has gone bad removes nothing either.
int unlinkat(int place, const char* path, int flags) {
  char whole[PATH_MAX];
  const int in = disk_path(place, path, whole);
  if (in && fails_at && calls >= fails_at && lasts && kind == EIO) {
    errno = EIO;
    return -1;
  }
  const int done = (int)syscall(SYS_unlinkat, place, path, flags);
  if (in && !done) disk_removed(whole);
  return done;
}
int unlink(const char* path) { return unlinkat(AT_FDCWD, path, 0); }
int rmdir(const char* path) { return unlinkat(AT_FDCWD, path, AT_REMOVEDIR); }

static int open_at(int place, const char* path, int flags, mode_t mode) {
  char whole[PATH_MAX];
  const int made = flags & O_CREAT && disk_path(place, path, whole);
  if (made && fails(kGrows | kIsRepeated)) return -1;
  const int is_new = made && faccessat(place, path, F_OK, 0);
  const int file = (int)syscall(SYS_openat, place, path, flags, mode);
  if (file >= 0) disk_opened(file);
  if (file >= 0 && is_new) disk_made(whole);
  return file;
}

#define MODE                                                            \
  va_list rest;                                                         \
  va_start(rest, flags);                                                \
  const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0; \
  va_end(rest);
#define OPEN(name) \
  int name(const char* path, int flags, ...) { MODE return open_at(AT_FDCWD, path, flags, mode); }
#define OPEN_AT(name) \
  int name(int place, const char* path, int flags, ...) { MODE return open_at(place, path, flags, mode); }
OPEN(open)
OPEN(open64)
OPEN_AT(openat)
OPEN_AT(openat64)

// What else changes a file. A library that begins to use one of them is noticed.
#define REAL(name) static __typeof__(name)* real; if (!real) *(void**)&real = dlsym(RTLD_NEXT, #name)
#define NEVER(type, name, parameters, arguments, file)         \
  type name parameters {                                       \
    REAL(name);                                                \
    if (to_write(file)) disk_give_up(#name " is not followed"); \
    return real arguments;                                     \
  }
typedef const struct iovec* Parts;
NEVER(ssize_t, pwrite, (int f, const void* d, size_t n, off_t at), (f, d, n, at), f)
NEVER(ssize_t, pwrite64, (int f, const void* d, size_t n, off64_t at), (f, d, n, at), f)
NEVER(ssize_t, writev, (int f, Parts d, int n), (f, d, n), f)
NEVER(ssize_t, pwritev, (int f, Parts d, int n, off_t at), (f, d, n, at), f)
NEVER(ssize_t, pwritev64, (int f, Parts d, int n, off64_t at), (f, d, n, at), f)
NEVER(int, posix_fallocate, (int f, off_t at, off_t n), (f, at, n), f)
NEVER(int, posix_fallocate64, (int f, off64_t at, off64_t n), (f, at, n), f)
NEVER(int, fallocate, (int f, int mode, off_t at, off_t n), (f, mode, at, n), f)
NEVER(int, fallocate64, (int f, int mode, off64_t at, off64_t n), (f, mode, at, n), f)
NEVER(ssize_t, copy_file_range, (int from, off64_t* a, int f, off64_t* b, size_t n, unsigned flags),
      (from, a, f, b, n, flags), f)
NEVER(FILE*, fdopen, (int f, const char* mode), (f, mode), f)

#define STREAM(name)                                                                      \
  FILE* name(const char* path, const char* mode) {                                        \
    REAL(name);                                                                           \
    char whole[PATH_MAX];                                                                 \
    if (disk_path(AT_FDCWD, path, whole) && strpbrk(mode, "wa+")) disk_give_up(#name " is not followed"); \
    return real(path, mode);                                                              \
  }
STREAM(fopen)
STREAM(fopen64)

#define NAMED(name)                                                                       \
  int name(char* path) {                                                                  \
    REAL(name);                                                                           \
    char whole[PATH_MAX];                                                                 \
    if (disk_path(AT_FDCWD, path, whole)) disk_give_up(#name " is not followed");         \
    return real(path);                                                                    \
  }
NAMED(mkstemp)
NAMED(mkstemp64)

#define MAP(name, offset)                                                                 \
  void* name(void* at, size_t size, int allowed, int flags, int file, offset place) {     \
    if (flags & MAP_SHARED && allowed & PROT_WRITE && to_write(file)) disk_give_up("mmap is not followed"); \
    return (void*)syscall(SYS_mmap, at, size, allowed, flags, file, place);               \
  }
MAP(mmap, off_t)
MAP(mmap64, off64_t)
