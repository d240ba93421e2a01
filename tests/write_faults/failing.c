// Before the C library: the n-th call that changes a file in one folder fails, or the power does. With the power goes
// what was not synced: bytes of a file, open or closed, and the names that its folder got since the folder was synced.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { kMost = 4096, kNames = 256 };
static char folder[PATH_MAX];
static long calls, fails_at;
static int error_number;  // 0: the power fails
static off_t on_disk[kMost];

// A name that its folder does not have on the disk yet; `from` is empty of a new file, `old` where nothing was replaced.
struct name {
  char to[PATH_MAX], from[PATH_MAX], old[PATH_MAX];
};
static struct name names[kNames];
static int named;
// Files that were closed with bytes that are not on the disk.
struct closed {
  char path[PATH_MAX];
  off_t size;
};
static struct closed closed[kNames];
static int forgotten;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

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

static int path_of(int file, char* path) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, PATH_MAX - 1);
  if (length < 0) return 0;
  path[length] = 0;
  return 1;
}

static int mine(int file) {
  char path[PATH_MAX];
  return folder[0] && file >= 3 && file < kMost && path_of(file, path) && inside(path);
}

static void give_up(const char* why) {
  fprintf(stderr, "failing.c: %s\n", why);
  abort();
}

static struct name* new_name(const char* to) {
  if (named == kNames) give_up("too many names");
  struct name* made = &names[named++];
  snprintf(made->to, PATH_MAX, "%s", to);
  made->from[0] = made->old[0] = 0;
  return made;
}

// What stands in `place` since its last sync stays.
static void keep_names(const char* place) {
  const size_t length = strlen(place);
  int left = 0;
  for (int i = 0; i < named; ++i) {
    const char* end = strrchr(names[i].to, '/');
    if ((size_t)(end - names[i].to) == length && !strncmp(names[i].to, place, length)) {
      if (names[i].old[0]) unlink(names[i].old);
    } else {
      names[left++] = names[i];
    }
  }
  named = left;
}

// The power fails now.
void lose(void) {
  pthread_mutex_lock(&lock);
  for (int file = 3; file < kMost; ++file) {
    struct stat now;
    if (!mine(file) || fstat(file, &now) || !S_ISREG(now.st_mode)) continue;
    if (now.st_size > on_disk[file] && ftruncate(file, on_disk[file])) give_up("cannot lose bytes");
  }
  for (int i = 0; i < forgotten; ++i) {
    if (truncate(closed[i].path, closed[i].size) && errno != ENOENT) give_up("cannot lose bytes");
  }
  int (*moved)(const char*, const char*);
  *(void**)&moved = dlsym(RTLD_NEXT, "rename");
  for (int i = named; i-- > 0;) {
    const struct name* each = &names[i];
    if (each->from[0]) {
      moved(each->to, each->from);
      if (each->old[0]) moved(each->old, each->to);
    } else {
      unlink(each->to);
    }
  }
  _exit(99);
}

static int fails(void) {
  if (!fails_at || ++calls != fails_at) return 0;
  if (!error_number) lose();
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
  if (fstat(file, &now)) return 0;
  char path[PATH_MAX];
  pthread_mutex_lock(&lock);
  if (!S_ISDIR(now.st_mode)) {
    on_disk[file] = now.st_size;
  } else if (path_of(file, path)) {
    keep_names(path);
  }
  pthread_mutex_unlock(&lock);
  return 0;
}

int close(int file) {
  REAL(close);
  struct stat now;
  if (mine(file) && !fstat(file, &now) && S_ISREG(now.st_mode) && now.st_size > on_disk[file]) {
    pthread_mutex_lock(&lock);
    if (forgotten == kNames) give_up("too many closed files");
    closed[forgotten].size = on_disk[file];
    path_of(file, closed[forgotten++].path);
    pthread_mutex_unlock(&lock);
  }
  return real(file);
}

int ftruncate64(int file, off64_t size) {
  REAL(ftruncate64);
  if (mine(file) && fails_counting()) return -1;
  if (mine(file) && on_disk[file] > size) on_disk[file] = size;
  return real(file, size);
}

int rename(const char* from, const char* to) {
  REAL(rename);
  if (!inside(to)) return real(from, to);
  if (fails_counting()) return -1;
  pthread_mutex_lock(&lock);
  struct name* made = new_name(to);
  snprintf(made->from, PATH_MAX, "%s", from);
  // Beside the folder: who lists it does not see this.
  snprintf(made->old, PATH_MAX, "%.3000s.old%d", folder, named);
  unlink(made->old);
  if (link(to, made->old)) made->old[0] = 0;
  for (int i = 0; i < forgotten; ++i) {
    if (!strcmp(closed[i].path, from)) snprintf(closed[i].path, PATH_MAX, "%s", to);
  }
  const int done = real(from, to);
  if (done) --named;
  pthread_mutex_unlock(&lock);
  return done;
}

static int opened(int file, const char* path, int is_new) {
  struct stat now;
  if (file < 0 || file >= kMost || fstat(file, &now)) return file;
  on_disk[file] = now.st_size;
  if (is_new && inside(path)) {
    pthread_mutex_lock(&lock);
    new_name(path);
    pthread_mutex_unlock(&lock);
  }
  return file;
}

#define OPEN(name)                                                            \
  int name(const char* path, int flags, ...) {                                \
    REAL(name);                                                               \
    va_list rest;                                                             \
    va_start(rest, flags);                                                    \
    const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;           \
    va_end(rest);                                                             \
    if ((flags & O_CREAT) && inside(path) && fails_counting()) return -1;     \
    const int is_new = (flags & O_CREAT) && access(path, F_OK);               \
    return opened(real(path, flags, mode), path, is_new);                     \
  }

OPEN(open)
OPEN(open64)
