/* clock.c: a clock() for FreeFEM, which reads the processor clock twice a statement by a system
   call. This one reads it only after a tick of the coarse clock (every 1 to 10 ms), which needs no
   system call. Results are the same to the byte. freefem.py of orchestrate/ffimpact/freefem builds
   and preloads it; by hand:
     cc -O2 -shared -fPIC -o libclock.so edp/program/clock.c
     LD_PRELOAD=$PWD/libclock.so FreeFem++ -nw edp/program/bodies.edp */
#include <time.h>

clock_t clock(void)
{
  static __thread struct timespec tick;
  static __thread clock_t used;
  struct timespec now, processor;
  clock_gettime(CLOCK_MONOTONIC_COARSE, &now);
  if (now.tv_sec != tick.tv_sec || now.tv_nsec != tick.tv_nsec) {
    tick = now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &processor);
    used = processor.tv_sec * CLOCKS_PER_SEC + processor.tv_nsec / (1000000000 / CLOCKS_PER_SEC);
  }
  return used;
}
