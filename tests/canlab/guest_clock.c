/* The guest's clock, preloaded into User Mode Linux: it stands still while the host does other
   things.

   The guest's kernel reads its time, arms its one timer and waits for it through the four functions
   below. While it works, its clock runs with the host's, by no more than MOST between two readings:
   what is more is the host's doing, which has other programs to run. While it has nothing to do,
   its clock jumps to the time at which the timer is due. So no time that passes in the guest
   depends on how busy the host is, and nobody waits. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <time.h>

typedef long long nanoseconds;

#define SECOND 1000000000LL
#define MOST 50000LL /* 50 µs */

static nanoseconds guest, host, due; /* due: when the timer expires; 0: it is not armed */

static int real_clock(clockid_t clock, struct timespec* time) {
  static int (*next)(clockid_t, struct timespec*);
  if (!next) next = dlsym(RTLD_NEXT, "clock_gettime");
  return next(clock, time);
}

static nanoseconds now(void) {
  struct timespec time;
  real_clock(CLOCK_MONOTONIC, &time);
  nanoseconds const read = time.tv_sec * SECOND + time.tv_nsec, passed = read - host;
  if (!host)
    guest = read; /* the first reading */
  else if (passed > 0)
    guest += passed < MOST ? passed : MOST;
  host = read;
  return guest;
}

int clock_gettime(clockid_t clock, struct timespec* time) {
  if (clock != CLOCK_MONOTONIC) return real_clock(clock, time);
  nanoseconds const read = now();
  time->tv_sec = read / SECOND;
  time->tv_nsec = read % SECOND;
  return 0;
}

int timer_settime(timer_t timer, int flags, struct itimerspec const* value,
                  struct itimerspec* old) {
  static int (*next)(timer_t, int, struct itimerspec const*, struct itimerspec*);
  if (!next) next = dlsym(RTLD_NEXT, "timer_settime");
  nanoseconds const wait = value->it_value.tv_sec * SECOND + value->it_value.tv_nsec;
  due = wait ? now() + wait : 0;
  /* Armed for the host, too: it interrupts a program that computes. If the guest's clock is not
     there yet, its kernel arms it again. */
  return next(timer, flags, value, old);
}

int sigsuspend(sigset_t const* mask) {
  static int (*next)(sigset_t const*);
  if (!next) next = dlsym(RTLD_NEXT, "sigsuspend");
  if (due) {
    if (guest < due) guest = due;
    struct timespec time;
    real_clock(CLOCK_MONOTONIC, &time);
    host = time.tv_sec * SECOND + time.tv_nsec;
    due = 0;
    raise(SIGALRM); /* blocked until the mask is in place */
  }
  return next(mask);
}
