/* Times the same RVEs as one batch and as many: batch_sizes CASE SETTINGS THREADS N SIZE... prints for each size of a
 * batch the seconds that N RVEs take to be made, and to answer with stresses and tangents (the least of ten
 * evaluations). It checks that all answers have the same bits. SETTINGS are parted by commas. The strain, 1e-4, is that
 * of an increment of a mesh. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <voussoir.h>

enum { evaluations = 10 };

static double now(void) {
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void require(int code) {
  if (code == voussoir_ok) return;
  printf("%s\n", voussoir_last_error());
  exit(1);
}

/* Every RVE is sheared and compressed by 1e-4, each one somewhat otherwise. */
static void fill(double* gradients, long n) {
  memset(gradients, 0, sizeof(double) * 4 * (size_t)n);
  for (long k = 0; k < n; ++k) {
    const double share = (double)(k % 7) / 7;
    gradients[4 * k + 1] = 1.0e-4 * share;
    gradients[4 * k + 3] = -1.0e-4 * (1 - share);
  }
}

static void run(const char* file, const char* settings, long n, long size, double* stress) {
  const long batches = (n + size - 1) / size;
  VoussoirRves** rves = calloc((size_t)batches, sizeof *rves);
  double* gradients = malloc(sizeof(double) * 4 * (size_t)n);
  double* tangent = malloc(sizeof(double) * 9 * (size_t)n);
  if (rves == NULL || gradients == NULL || tangent == NULL) exit(1);
  fill(gradients, n);
  const double start = now();
  for (long b = 0; b < batches; ++b) {
    const long points = b * size + size <= n ? size : n - b * size;
    require(voussoir_create(file, points, settings, NULL, NULL, &rves[b]));
  }
  const double made = now() - start;
  double least = HUGE_VAL;
  double least_cpu = HUGE_VAL;
  for (int i = 0; i < evaluations; ++i) {
    const double begin = now();
    const clock_t begin_cpu = clock();
    for (long b = 0; b < batches; ++b) {
      const long k = b * size;
      require(
          voussoir_evaluate(rves[b], voussoir_size(rves[b]), gradients + 4 * k, stress + 3 * k, tangent + 9 * k, NULL));
    }
    least = fmin(least, now() - begin);
    least_cpu = fmin(least_cpu, (double)(clock() - begin_cpu) / CLOCKS_PER_SEC);
  }
  printf("%ld batches of %ld: made in %.3f s, one evaluation of all RVEs in %.4f s (%.4f s of the processors)\n",
         batches, size, made, least, least_cpu);
  for (long b = 0; b < batches; ++b) require(voussoir_destroy(rves[b]));
  free(rves);
  free(gradients);
  free(tangent);
}

int main(int argc, char** argv) {
  if (argc < 6) return 2;
  const long threads = strtol(argv[3], NULL, 10);
  const long n = strtol(argv[4], NULL, 10);
  if (n < 1) return 2;
  double* first = malloc(sizeof(double) * 3 * (size_t)n);
  double* stress = malloc(sizeof(double) * 3 * (size_t)n);
  if (first == NULL || stress == NULL) return 1;
  for (char* comma = argv[2]; (comma = strchr(comma, ',')) != NULL;) *comma = '\n';
  require(voussoir_start((int32_t)threads));
  printf("%ld RVEs on %d threads\n", n, voussoir_threads());
  for (int a = 5; a < argc; ++a) {
    const long size = strtol(argv[a], NULL, 10);
    if (size < 1) return 2;
    run(argv[1], argv[2], n, size, a == 5 ? first : stress);
    if (a > 5 && memcmp(first, stress, sizeof(double) * 3 * (size_t)n) != 0) {
      printf("FAILED: the answers differ\n");
      return 1;
    }
  }
  free(first);
  free(stress);
  return 0;
}
