// What of one folder is on the disk, and what the power takes with it.
#pragma once
#include <sys/types.h>

// Follows this folder from now on.
void disk_begin(const char* where);
// The whole path of one that is given relative to `place` (as of openat), if it is in the folder.
int disk_path(int place, const char* path, char* whole);
// Whether a descriptor is of a file in the folder, and which.
int disk_file(int file, char* whole);
// Whether a file's next byte would replace one that is on the disk.
int disk_replaces(int file);
// After each of these: a file that was opened, a new name, one that is gone, a file that was cut or synced.
void disk_opened(int file);
void disk_made(const char* path);
void disk_removed(const char* path);
void disk_cut(int file, off_t size);
void disk_synced(int file);
int disk_move(const char* from, const char* to);  // in its place
void disk_closing(int file);
// The power fails now.
_Noreturn void disk_lose(void);
_Noreturn void disk_give_up(const char* why);
