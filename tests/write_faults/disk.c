// The power takes what was not synced: bytes of a file, open or closed, and the names that a folder got since its sync.
#define _GNU_SOURCE
#include "disk.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { kMost = 4096, kNames = 256, kPowerless = 99 };
static char folder[PATH_MAX];
static pid_t process;  // a child closes what it inherits, and may share this memory until it runs another program
static off_t on_disk[kMost];  // bytes of each open file

// A name that its folder does not have on the disk yet; `from` is empty of a new one, `old` where nothing was replaced.
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

_Noreturn void disk_give_up(const char* why) {
  fprintf(stderr, "disk.c: %s\n", why);
  abort();
}

void disk_begin(const char* where) {
  snprintf(folder, sizeof folder, "%s", where);
  process = getpid();
}

static int inside(const char* path) {
  const size_t length = strlen(folder);
  return length && !strncmp(path, folder, length) && (path[length] == '/' || !path[length]);
}

// Where a descriptor leads.
static int path_of(int file, char* path) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, PATH_MAX - 1);
  if (length < 0) return 0;
  path[length] = 0;
  return 1;
}

int disk_path(int place, const char* path, char* whole) {
  if (!folder[0] || !path || !path[0] || getpid() != process) return 0;
  char given[PATH_MAX], parent[PATH_MAX];
  if (path[0] == '/') {
    snprintf(given, sizeof given, "%s", path);
  } else {
    if (place == AT_FDCWD ? !getcwd(parent, sizeof parent) : !path_of(place, parent)) return 0;
    if (snprintf(given, sizeof given, "%s/%s", parent, path) >= PATH_MAX) return 0;
  }
  char* name = strrchr(given, '/');
  *name++ = 0;
  if (!realpath(given[0] ? given : "/", parent)) return 0;  // `..` and links on the way
  if (!strcmp(name, ".")) {
    snprintf(whole, PATH_MAX, "%s", parent);
  } else if (snprintf(whole, PATH_MAX, "%s/%s", parent, name) >= PATH_MAX) {
    return 0;
  }
  return inside(whole);
}

int disk_file(int file, char* whole) {
  return folder[0] && file >= 3 && file < kMost && getpid() == process && path_of(file, whole) && inside(whole);
}

int disk_replaces(int file) {
  return !(fcntl(file, F_GETFL) & O_APPEND) && lseek(file, 0, SEEK_CUR) < on_disk[file];
}

static struct name* new_name(const char* to) {
  if (named == kNames) disk_give_up("too many names");
  struct name* made = &names[named++];
  snprintf(made->to, PATH_MAX, "%s", to);
  made->from[0] = made->old[0] = 0;
  return made;
}

void disk_made(const char* path) {
  pthread_mutex_lock(&lock);
  new_name(path);
  pthread_mutex_unlock(&lock);
}

void disk_opened(int file) {
  struct stat now;
  char path[PATH_MAX];
  if (!disk_file(file, path) || fstat(file, &now)) return;
  pthread_mutex_lock(&lock);
  on_disk[file] = now.st_size;
  for (int i = 0; i < forgotten; ++i) {  // its end may have been written before, and not be on the disk either
    if (!strcmp(closed[i].path, path) && closed[i].size < on_disk[file]) on_disk[file] = closed[i].size;
  }
  pthread_mutex_unlock(&lock);
}

// The C library's functions of these names may be the layer's own.
static int cut(int file, off_t size) { return (int)syscall(SYS_ftruncate, file, size); }
static int removed(const char* path) { return (int)syscall(SYS_unlinkat, AT_FDCWD, path, 0); }
static int moved(const char* from, const char* to) {
  return (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}
static int linked(const char* from, const char* to) {
  return (int)syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0);
}

int disk_move(const char* from, const char* to) {
  pthread_mutex_lock(&lock);
  struct name* made = new_name(to);
  snprintf(made->from, PATH_MAX, "%s", from);
  // Beside the folder: who lists it does not see this.
  snprintf(made->old, PATH_MAX, "%.3000s.old%d", folder, named);
  removed(made->old);
  if (linked(to, made->old)) made->old[0] = 0;
  const int done = moved(from, to);
  if (done) --named;
  for (int i = 0; i < forgotten && !done; ++i) {
    if (!strcmp(closed[i].path, from)) snprintf(closed[i].path, PATH_MAX, "%s", to);
  }
  pthread_mutex_unlock(&lock);
  return done;
}

// What was made and removed since the last sync is nothing; any other removal counts as on the disk.
void disk_removed(const char* path) {
  pthread_mutex_lock(&lock);
  int left = 0;
  for (int i = 0; i < named; ++i) {
    if (names[i].from[0] || strcmp(names[i].to, path)) names[left++] = names[i];
  }
  named = left;
  pthread_mutex_unlock(&lock);
}

void disk_cut(int file, off_t size) {
  if (on_disk[file] > size) on_disk[file] = size;
}

// What stands in `place` since its last sync stays.
static void keep_names(const char* place) {
  const size_t length = strlen(place);
  int left = 0;
  for (int i = 0; i < named; ++i) {
    const char* end = strrchr(names[i].to, '/');
    if ((size_t)(end - names[i].to) == length && !strncmp(names[i].to, place, length)) {
      if (names[i].old[0]) removed(names[i].old);
    } else {
      names[left++] = names[i];
    }
  }
  named = left;
}

void disk_synced(int file) {
  struct stat now;
  char path[PATH_MAX];
  if (fstat(file, &now) || !path_of(file, path)) return;
  pthread_mutex_lock(&lock);
  if (S_ISDIR(now.st_mode)) {
    keep_names(path);
  } else {
    on_disk[file] = now.st_size;
    int left = 0;
    for (int i = 0; i < forgotten; ++i) {
      if (strcmp(closed[i].path, path)) closed[left++] = closed[i];
    }
    forgotten = left;
  }
  pthread_mutex_unlock(&lock);
}

void disk_closing(int file) {
  struct stat now;
  char path[PATH_MAX];
  if (!disk_file(file, path) || fstat(file, &now) || !S_ISREG(now.st_mode)) return;
  if (now.st_size <= on_disk[file]) return;
  pthread_mutex_lock(&lock);
  if (forgotten == kNames) disk_give_up("too many closed files");
  snprintf(closed[forgotten].path, PATH_MAX, "%s", path);
  closed[forgotten++].size = on_disk[file];
  pthread_mutex_unlock(&lock);
}

static int gone(const char* path, const struct stat* found, int kind, struct FTW* where) {
  (void)found, (void)where;
  return (int)syscall(SYS_unlinkat, AT_FDCWD, path, kind == FTW_DP ? AT_REMOVEDIR : 0);
}

_Noreturn void disk_lose(void) {
  pthread_mutex_lock(&lock);
  char path[PATH_MAX];
  for (int file = 3; file < kMost; ++file) {
    struct stat now;
    if (!disk_file(file, path) || fstat(file, &now) || !S_ISREG(now.st_mode)) continue;
    if ((fcntl(file, F_GETFL) & O_ACCMODE) == O_RDONLY) continue;
    if (now.st_size > on_disk[file] && cut(file, on_disk[file])) disk_give_up("cannot lose bytes");
  }
  for (int i = 0; i < forgotten; ++i) {
    if (syscall(SYS_truncate, closed[i].path, closed[i].size) && errno != ENOENT) disk_give_up("cannot lose bytes");
  }
  for (int i = named; i-- > 0;) {
    const struct name* each = &names[i];
    if (each->from[0]) {
      moved(each->to, each->from);
      if (each->old[0]) moved(each->old, each->to);
    } else {
      nftw(each->to, gone, 16, FTW_DEPTH | FTW_PHYS);  // a folder, with all in it
    }
  }
  _exit(kPowerless);
}
