/* A foreign program in C that uses the installed library: it deforms two RVEs as consumer.cpp does, saves and restores
 * their state, makes every mistake that the library can find, and ends. Arguments: a case file and a folder for
 * packings. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <voussoir.h>

static int failures = 0;

static void check(int holds, const char* sentence) {
  if (!holds) printf("FAILED: %s (%s)\n", sentence, voussoir_last_error());
  failures += holds ? 0 : 1;
}

static void count_line(const char* line, void* context) {
  if (line[0] != '\0') ++*(int*)context;
}

/* Without strain the stress stays; compression answers as consumer.cpp says. */
static void deform(VoussoirRves* rves) {
  const double gradients[8] = {0, 0, 0, 0, 0, 0, 0, -1.0e-5};
  double before[6], stress[6], tangent[18];
  int32_t status[2];
  VoussoirReport report;
  check(voussoir_committed(rves, 2, before, NULL) == voussoir_ok, "the committed stress is known");
  check(voussoir_commit(rves) == voussoir_misuse, "a commit needs an evaluation");
  check(voussoir_report(rves, &report) == voussoir_misuse, "a report needs an evaluation");
  check(voussoir_evaluate(rves, 2, gradients, stress, tangent, status) == voussoir_ok, "the RVEs answer");
  for (int k = 0; k < 2; ++k) {
    printf("stress [Pa] %.2f %.2f %.2f\n", stress[3 * k], stress[3 * k + 1], stress[3 * k + 2]);
    check(strcmp(voussoir_status_name(status[k]), "converged") == 0, "the RVEs come to rest");
  }
  check(voussoir_report(rves, &report) == voussoir_ok && report.failed == 0 && report.work > 0, "the report counts");
  const double foretold = before[4] - 1.0e-5 * tangent[9 + 4];
  check(fabs(stress[4] - foretold) < 0.3 * fabs(foretold - before[4]), "the tangent foretells the stress");
  check(tangent[9 + 1] == tangent[9 + 3], "the tangent is symmetric");
  check(voussoir_commit(rves) == voussoir_ok, "the increment is committed");
  check(voussoir_commit(rves) == voussoir_misuse, "an evaluation is committed once");
  check(voussoir_committed(rves, 2, before, NULL) == voussoir_ok, "the committed stress is known");
  check(memcmp(before, stress, sizeof stress) == 0, "the committed stress is that of the last evaluation");
}

/* A state that was saved and restored gives the same bits. */
static void save_and_restore(VoussoirRves* rves) {
  const double gradients[8] = {1.0e-5, 0, 0, 0, 0, 1.0e-5, 0, -2.0e-5};
  double first[6], second[6];
  int64_t size = 0;
  check(voussoir_state_size(rves, &size) == voussoir_ok && size > 0, "the state has a size");
  char* state = malloc((size_t)size);
  if (state == NULL) return;
  check(voussoir_get_state(rves, state, size) == voussoir_ok, "the state is saved");
  check(voussoir_get_state(rves, state, size - 1) == voussoir_misuse, "a buffer of another size is refused");
  check(voussoir_evaluate(rves, 2, gradients, first, NULL, NULL) == voussoir_ok, "the RVEs answer");
  check(voussoir_commit(rves) == voussoir_ok, "the increment is committed");
  check(voussoir_set_state(rves, state, size) == voussoir_ok, "the state is restored");
  check(voussoir_commit(rves) == voussoir_misuse, "nothing can be committed after a restored state");
  check(voussoir_evaluate(rves, 2, gradients, second, NULL, NULL) == voussoir_ok, "the RVEs answer");
  check(memcmp(first, second, sizeof first) == 0, "the restored state answers with the same bits");
  state[8] ^= 1;
  check(voussoir_set_state(rves, state, size) == voussoir_wrong_input, "a damaged state is refused");
  check(voussoir_set_state(rves, state, 3) == voussoir_wrong_input, "a state that is cut off is refused");
  free(state);
}

/* An RVE without an answer: its stress is NaN, the other one's is right, and a commit is refused. */
static void crush(VoussoirRves* rves) {
  const double gradients[8] = {0, 0, 0, 0, 0, 0, 0, -0.9};
  const double wrong[8] = {0, 0, 0, 0, 0, 0, 0, NAN};
  const double not_minus_identity[8] = {1, 0, 0, 1, 1, 0.001, 0, 0.99};
  double stress[6], tangent[18];
  int32_t status[2];
  check(voussoir_evaluate(rves, 2, not_minus_identity, stress, NULL, NULL) == voussoir_misuse, "F is not taken for H");
  check(strstr(voussoir_last_error(), "F minus identity") != NULL, "and it is said");
  check(voussoir_evaluate(rves, 2, gradients, stress, tangent, status) == voussoir_no_equilibrium, "it is crushed");
  printf("crushed: %s\n", voussoir_last_error());
  check(status[0] == voussoir_converged && status[1] >= voussoir_neighbour_overflow, "the status tells which RVE");
  check(isfinite(stress[0]) && isnan(stress[3]) && isnan(tangent[17]), "an RVE without an answer has NaN");
  check(voussoir_commit(rves) == voussoir_misuse, "it is not committed");
  check(voussoir_evaluate(rves, 2, wrong, stress, tangent, status) == voussoir_misuse, "a gradient is a number");
  check(isnan(stress[0]) && isnan(tangent[0]) && status[0] == -1, "a refused call leaves no old answers");
}

static void read_fields(VoussoirRves* rves) {
  const char* name = NULL;
  const char* unit = NULL;
  int32_t components = 0;
  int64_t count = 0;
  double values[2] = {0, 0};
  check(voussoir_field_count(rves, &count) == voussoir_ok && count > 3, "there are fields");
  check(voussoir_field(rves, 0, &name, &unit, &components) == voussoir_ok, "a field has a name");
  check(name != NULL && unit != NULL && components == 1, "a field is described");
  check(voussoir_field(rves, count, &name, NULL, NULL) == voussoir_misuse, "there is no field beyond the last one");
  check(voussoir_field_values(rves, "void_ratio", values, 2) == voussoir_ok, "the void ratio is known");
  printf("void ratio %.4f\n", values[0]);
  check(values[0] > 0.1 && values[0] < 0.4, "the void ratio is one of sand");
  check(voussoir_field_values(rves, "void_ratio", values, 3) == voussoir_misuse, "a wrong size is refused");
  check(voussoir_field_values(rves, "colour", values, 2) == voussoir_misuse, "a wrong name is refused");
}

static void make_mistakes(VoussoirRves* rves, const char* file) {
  double numbers[18] = {0};
  int64_t size = 0;
  VoussoirRves* none = rves;
  check(voussoir_create(file, 1, "packing.grain=5", NULL, NULL, &none) == voussoir_wrong_input,
        "a wrong key is refused");
  printf("refused: %s\n", voussoir_last_error());
  check(none == NULL && strstr(voussoir_last_error(), "packing.grain") != NULL, "the key is named");
  check(voussoir_create("none.toml", 1, NULL, NULL, NULL, &none) != voussoir_ok, "a file that is not there is refused");
  check(strstr(voussoir_last_error(), "none.toml") != NULL, "the file is named");
  check(voussoir_create(file, 0, NULL, NULL, NULL, &none) == voussoir_misuse, "no RVE is refused");
  check(voussoir_create(NULL, 1, NULL, NULL, NULL, &none) == voussoir_misuse, "no file is refused");
  check(voussoir_create(file, 1, NULL, NULL, NULL, NULL) == voussoir_misuse, "no handle is refused");
  check(voussoir_evaluate(rves, 3, numbers, numbers, NULL, NULL) == voussoir_misuse, "a wrong n is refused");
  check(voussoir_evaluate(rves, 2, NULL, numbers, NULL, NULL) == voussoir_misuse, "no gradients are refused");
  check(isnan(numbers[0]) && isnan(numbers[5]) && numbers[6] == 0, "and leave no old answers");
  check(voussoir_evaluate(rves, 2, numbers, NULL, NULL, NULL) == voussoir_misuse, "no stress is refused");
  check(voussoir_evaluate(NULL, 2, numbers, numbers, NULL, NULL) == voussoir_misuse, "NULL is refused");
  check(voussoir_commit((VoussoirRves*)numbers) == voussoir_misuse, "a pointer that is no handle is refused");
  check(voussoir_state_size(rves, NULL) == voussoir_misuse, "a number needs a place");
  check(voussoir_state_size(NULL, &size) == voussoir_misuse, "NULL has no state");
  check(voussoir_start(-1) == voussoir_misuse, "a negative number of threads is refused");
  check(voussoir_start(1) == voussoir_ok && voussoir_start(0) == voussoir_ok, "the same start is no mistake");
  check(voussoir_start(2) == voussoir_misuse, "the number of threads stays");
  check(voussoir_destroy(NULL) == voussoir_ok, "NULL needs no end");
}

int main(int argc, char** argv) {
  char settings[4096];
  double stress[6];
  int lines = 0;
  VoussoirRves* rves = NULL;
  if (argc != 3) return 2;
  snprintf(settings, sizeof settings, "packing.folder=%s", argv[2]);
  check(voussoir_create(argv[1], 2, settings, NULL, NULL, &rves) == voussoir_misuse,
        "nothing is made before the start");
  check(voussoir_start(1) == voussoir_ok && voussoir_threads() == 1, "the threads start");
  check(voussoir_create(argv[1], 2, settings, count_line, &lines, &rves) == voussoir_ok, "the RVEs are made");
  if (rves == NULL) return 1;
  check(voussoir_size(rves) == 2 && lines > 0, "there are two RVEs, and the log had lines");
  deform(rves);
  read_fields(rves);
  save_and_restore(rves);
  crush(rves);
  make_mistakes(rves, argv[1]);

  VoussoirRves* others = NULL;
  VoussoirRves* rves_anew = NULL;
  check(voussoir_create(argv[1], 1, settings, NULL, NULL, &others) == voussoir_ok, "others are made");
  check(voussoir_destroy(others) == voussoir_ok, "they are freed");
  check(voussoir_create(argv[1], 1, settings, NULL, NULL, &rves_anew) == voussoir_ok, "and made anew");
  check(voussoir_destroy(others) == voussoir_misuse && voussoir_size(others) == 0, "the old handle stays dead");
  check(strstr(voussoir_last_error(), "freed by voussoir_destroy") != NULL, "and it is known what ended it");
  check(voussoir_stop() == voussoir_ok && voussoir_threads() == 0, "the threads end");
  check(voussoir_committed(rves, 2, stress, NULL) == voussoir_misuse, "the RVEs end with the threads");
  check(voussoir_start(1) == voussoir_misuse, "the threads start once in a process");
  check(voussoir_stop() == voussoir_ok, "a second end is no mistake");
  printf("Voussoir %s, %d failures\n", voussoir_version(), failures);
  return failures == 0 ? 0 : 1;
}
