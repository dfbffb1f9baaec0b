/* LD_PRELOAD shim: makes one call of the operating system fail, to see what the program does then.
 *
 *   SOFTGRAIN_FAIL=write:17     the 17th write fails, once; also fsync, rename, open, flock, malloc
 *   SOFTGRAIN_FAIL=write:17+    it and every later one, as on a disk that stays full
 *   SOFTGRAIN_FLOCK_ERROR=38    errno of a flock that fails
 *   SOFTGRAIN_FAIL_COUNT=FILE   at the end, how many calls there were of the kind asked for
 *
 * Calls count from main on; calls inside libc do not pass here, nor count. Memory that HDF5 asks for does not
 * count either: version 1.10.8 crashes when it gets none (in its start, and in its own report of that error). */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/types.h>
#include <unistd.h>

extern void* __libc_malloc(size_t size);
extern void* __libc_calloc(size_t count, size_t size);
extern void* __libc_realloc(void* at, size_t size);

static char kind[16];  /* "" until the settings are read */
static long first_failure; /* 0: none */
static int persistent;
static atomic_long calls;

static void read_settings(void) {
  const char* settings = getenv("SOFTGRAIN_FAIL");
  const char* colon = settings == NULL ? NULL : strchr(settings, ':');
  if (colon == NULL || (size_t)(colon - settings) >= sizeof kind) return;
  first_failure = atol(colon + 1);
  persistent = settings[strlen(settings) - 1] == '+';
  memcpy(kind, settings, (size_t)(colon - settings));
}

__attribute__((destructor)) static void report_count(void) {
  const char* path = getenv("SOFTGRAIN_FAIL_COUNT");
  const long count = atomic_load(&calls);
  kind[0] = '\0';
  if (path == NULL) return;
  FILE* file = fopen(path, "w");
  if (file == NULL) return;
  fprintf(file, "%ld\n", count);
  fclose(file);
}

static int (*program)(int, char**, char**);

static int main_under_settings(int count, char** words, char** environment) {
  read_settings();
  return program(count, words, environment);
}

/* What starts main. */
int __libc_start_main(int (*main)(int, char**, char**), int count, char** words, void (*begin)(void),
                      void (*end)(void), void (*linker_end)(void), void* stack_end) {
  program = main;
  return ((__typeof__(&__libc_start_main))dlsym(RTLD_NEXT, "__libc_start_main"))(
      main_under_settings, count, words, begin, end, linker_end, stack_end);
}

/* Is it this call that fails? */
static int fails(const char* call) {
  if (kind[0] == '\0' || strcmp(kind, call) != 0) return 0;
  const long number = atomic_fetch_add(&calls, 1) + 1;
  return first_failure > 0 && (persistent ? number >= first_failure : number == first_failure);
}

static int memory_fails(const void* caller) {
  Dl_info from;
  if (strcmp(kind, "malloc") != 0 || dladdr(caller, &from) == 0) return 0;
  if (strstr(from.dli_fname, "libhdf5") != NULL || strstr(from.dli_fname, "libc.so") != NULL) return 0;
  return fails("malloc");
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t write(int file, const void* bytes, size_t size) {
  if (fails("write")) return errno = ENOSPC, -1;
  return NEXT(write)(file, bytes, size);
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  if (fails("write")) return errno = ENOSPC, -1;
  return NEXT(pwrite)(file, bytes, size, at);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  if (fails("write")) return errno = ENOSPC, -1;
  return NEXT(pwrite64)(file, bytes, size, at);
}

int fsync(int file) {
  if (fails("fsync")) return errno = EIO, -1;
  return NEXT(fsync)(file);
}

int rename(const char* from, const char* to) {
  if (fails("rename")) return errno = EACCES, -1;
  return NEXT(rename)(from, to);
}

int flock(int file, int operation) {
  const char* error = getenv("SOFTGRAIN_FLOCK_ERROR");
  if (fails("flock")) return errno = error == NULL ? ENOSYS : atoi(error), -1;
  return NEXT(flock)(file, operation);
}

static int mode_of(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, int) : 0;
}

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int mode = mode_of(flags, arguments);
  va_end(arguments);
  if (fails("open")) return errno = EMFILE, -1;
  return NEXT(open)(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int mode = mode_of(flags, arguments);
  va_end(arguments);
  if (fails("open")) return errno = EMFILE, -1;
  return NEXT(open64)(path, flags, mode);
}

#define MEMORY_FAILS (memory_fails(__builtin_return_address(0)) ? (errno = ENOMEM) : 0)

void* malloc(size_t size) { return MEMORY_FAILS ? NULL : __libc_malloc(size); }
void* calloc(size_t count, size_t size) { return MEMORY_FAILS ? NULL : __libc_calloc(count, size); }
void* realloc(void* at, size_t size) { return MEMORY_FAILS ? NULL : __libc_realloc(at, size); }
