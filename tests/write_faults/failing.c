// Before the C library: the n-th call that changes a file in one folder fails, or the power does.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { kMost = 4096 };
static char folder[PATH_MAX];
static long calls, fails_at;
static int error_number;  // 0: the power fails
static off_t on_disk[kMost];

// Counts the calls in `where`; the one with the number `at` (from 1; 0: none) fails.
void arm(const char* where, long at, int number) {
  snprintf(folder, sizeof folder, "%s", where);
  calls = 0;
  fails_at = at;
  error_number = number;
}

long counted(void) { return calls; }

static int inside(const char* path) {
  return folder[0] && path && strncmp(path, folder, strlen(folder)) == 0;
}

static int mine(int file) {
  char link[64], path[PATH_MAX];
  if (!folder[0] || file < 3 || file >= kMost) return 0;
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length < 0) return 0;
  path[length] = 0;
  return inside(path);
}

static void lose_power(void) {
  for (int file = 3; file < kMost; ++file) {
    struct stat now;
    if (!mine(file) || fstat(file, &now) || !S_ISREG(now.st_mode)) continue;
    if (now.st_size > on_disk[file] && ftruncate(file, on_disk[file])) continue;
  }
  _exit(99);
}

static int fails(void) {
  if (!fails_at || ++calls != fails_at) return 0;
  if (!error_number) lose_power();
  errno = error_number;
  return 1;
}

static int fails_counting(void) {
  if (fails_at) return fails();
  ++calls;
  return 0;
}

#define REAL(name) static __typeof__(name)* real; if (!real) *(void**)&real = dlsym(RTLD_NEXT, #name)

ssize_t write(int file, const void* data, size_t size) {
  REAL(write);
  if (mine(file) && fails_counting()) {
    if (size > 1 && real(file, data, size / 2) < 0) return -1;  // a full disk takes a part
    errno = error_number;
    return -1;
  }
  return real(file, data, size);
}

int fsync(int file) {
  REAL(fsync);
  if (!mine(file)) return real(file);
  if (fails_counting()) return -1;
  struct stat now;
  if (!fstat(file, &now)) on_disk[file] = now.st_size;
  return 0;
}

int ftruncate64(int file, off64_t size) {
  REAL(ftruncate64);
  if (mine(file) && fails_counting()) return -1;
  if (mine(file) && on_disk[file] > size) on_disk[file] = size;
  return real(file, size);
}

int rename(const char* from, const char* to) {
  REAL(rename);
  if (inside(to) && fails_counting()) return -1;
  return real(from, to);
}

static int opened(int file) {
  struct stat now;
  if (file >= 0 && file < kMost && !fstat(file, &now)) on_disk[file] = now.st_size;
  return file;
}

int open64(const char* path, int flags, ...) {
  REAL(open64);
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  if ((flags & O_CREAT) && inside(path) && fails_counting()) return -1;
  return opened(real(path, flags, mode));
}

int open(const char* path, int flags, ...) {
  REAL(open);
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  if ((flags & O_CREAT) && inside(path) && fails_counting()) return -1;
  return opened(real(path, flags, mode));
}
