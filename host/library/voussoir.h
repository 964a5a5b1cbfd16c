#ifndef VOUSSOIR_H
#define VOUSSOIR_H
/// The C interface: packings of grains as the material of a program in C, Fortran, Julia or any other language that
/// calls C. docs/how-to/use_from_c.md shows whole programs, docs/reference/public_interface.md the promise of
/// stability.
///
/// All numbers are SI (m, Pa); tension is positive. Arrays are dense and row by row, the point is the slowest index. A
/// vector of stress is (xx, yy, xy); the strains that a tangent multiplies are (xx, yy, gamma_xy), gamma_xy = 2 eps_xy.
///
/// Every function that can fail returns one of the codes below, which are the exit statuses of the program where the
/// program has one. No C++ exception leaves a function. A call that is refused leaves the committed state as it was
/// and changes nothing else but what its description says. No function ends the process, unless the memory ends within
/// a thread of the engine. Wrong pointers cannot be found, except NULL and handles that are not, or no longer, those of
/// RVEs.
///
/// Any thread may call. Calls wait for one another, because an evaluation uses all threads of the engine by itself. The
/// functions refuse to work in a process that was forked after voussoir_start.

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  voussoir_ok = 0,
  voussoir_misuse = 1,           ///< the call is wrong: NULL, a wrong size, a wrong order of calls, no number
  voussoir_wrong_input = 2,      ///< case, setting, packing file or state has a fault
  voussoir_no_equilibrium = 3,   ///< an RVE has no answer: make the increment smaller; or a packing comes to no rest
  voussoir_machine_failure = 4,  ///< memory or disk failed, or the library has an error within
  voussoir_interrupted = 130     ///< somebody asked the process to stop while it waited for a packing
};

/// How the evaluation of one RVE ended. From voussoir_neighbour_overflow on the RVE has no answer.
enum {
  voussoir_converged = 0,
  voussoir_step_limit = 1,          ///< not at rest after engine.hold_cap steps; the stress counts
  voussoir_open = 2,                ///< no contacts, stress 0; where it comes unexpected: were gradients H, not F?
  voussoir_neighbour_overflow = 3,  ///< too many neighbours, or a cell too narrow for its largest grains
  voussoir_overlap_limit = 4,       ///< grains overlap more than the law of the contacts allows
  voussoir_not_finite = 5           ///< a number became infinite
};

/// n RVEs. Only pointers to it are used.
typedef struct VoussoirRves VoussoirRves;

/// How good the answers of the last evaluation are.
typedef struct VoussoirReport {
  double stress_noise;      ///< rms uncertainty of the stresses of points at rest [Pa]
  double unsettled_stress;  ///< rms error that points at the step limit may have, over all points [Pa]
  double mean_overlap;      ///< the largest mean overlap of a point [-]
  double deferral_error;    ///< largest error of answers by the last tangent (engine.defer), over the pressure [-]
  int64_t work;             ///< particle-steps that were computed
  int64_t failed;           ///< points without an answer
  int64_t step_limit;       ///< points that were not at rest after engine.hold_cap steps
  int64_t open;             ///< points without contacts
  int64_t out_of_range;     ///< points beyond what the law of the grains is good for; their stresses count
  int64_t deferred;         ///< points that answered by their last tangent
} VoussoirReport;

/// Receives a line that the program would write into its log. It must not call a function of this header.
typedef void (*VoussoirNote)(const char* line, void* context);

/// Version of the library, such as "0.2.0".
const char* voussoir_version(void);

/// What was wrong at the last call of this thread that did not return voussoir_ok, as one sentence; it begins with
/// "file:line: key" where the input had a fault. "" where there was none. The text lives until the next such call.
const char* voussoir_last_error(void);

/// Name of the status of an RVE, such as "overlap_limit"; "" for a number that is no status.
const char* voussoir_status_name(int32_t status);

/// Starts the threads of the engine, once in a process. A second call is voussoir_ok if it asks for the same number or
/// for 0, and voussoir_misuse otherwise, and after voussoir_stop.
/// @param threads wanted number; 0: KOKKOS_NUM_THREADS, OMP_NUM_THREADS or one for each core
int voussoir_start(int32_t threads);

/// Frees all RVEs and ends the threads, which cannot start again in this process. It need not be called before the
/// process ends. Handles of RVEs stay handles: calls with them are voussoir_misuse. voussoir_ok where nothing runs.
int voussoir_stop(void);

/// Number of threads of the engine; 0 where it is not running.
int32_t voussoir_threads(void);

/// Makes n RVEs as a case file describes them (docs/reference/keys.md): tables [soil], [packing], [engine] and the kind
/// of tangent. Packings are found in packing.folder, or made, which takes seconds to minutes, or read from
/// packing.file. The RVEs begin at rest under the pressure of their packings, which is the committed stress.
/// @param case_file path of a case of the kind pack, probe, column or tunnel
/// @param n number of RVEs, one for each Gauss point; at least 1 and packing.variety
/// @param settings lines such as "packing.grains=300\nengine.precision=double", which override keys of the file; or
/// NULL
/// @param note receives the lines of the log; or NULL
/// @param context is given to `note`
/// @param rves receives the handle, or NULL in case of an error. voussoir_destroy frees it.
/// Codes: misuse, wrong_input (file, line and key in voussoir_last_error), no_equilibrium (a packing comes to no rest),
/// machine_failure.
int voussoir_create(const char* case_file, int64_t n, const char* settings, VoussoirNote note, void* context,
                    VoussoirRves** rves);

/// Frees the RVEs; NULL is allowed. A second call with the same handle is voussoir_misuse.
int voussoir_destroy(VoussoirRves* rves);

/// Number of RVEs, n; 0 where `rves` is no handle, or the RVEs are freed.
int64_t voussoir_size(const VoussoirRves* rves);

/// Begins the increment anew, after a cut for example. The numbers of steps of the grains follow from the first
/// evaluation of an increment and stay until its end, so that within an increment the stress is a fixed function of the
/// gradient. voussoir_commit begins the next increment by itself.
int voussoir_begin_increment(VoussoirRves* rves);

/// Moves the RVEs from the committed state; it may be called as often as needed before a commit.
/// @param n number of RVEs, as it was created: it guards against arrays of another size
/// @param gradients (n, 2, 2): the displacement gradient H = F - I [-] (F minus identity, and not F), where F maps the
/// committed configuration to the wanted one; with the rotation
/// @param stress (n, 3): Cauchy stress [Pa]
/// @param tangent (n, 3, 3), symmetric [Pa]; or NULL, which saves the cost of the tangents
/// @param status (n): how each RVE ended; or NULL
/// Codes: no_equilibrium where at least one RVE has no answer: its stress and tangent are NaN, those of the others are
/// right. misuse: gradients or stress is NULL; a gradient is not finite, or turns the cell inside out (det F <= 0); or
/// all gradients are within 0.1 of the identity matrix, as F is. This also refuses a single RVE whose H is meant to be
/// there, which doubles its cell.
///
/// With every other code but voussoir_ok, where the handle and n are right, all stresses and tangents are NaN, all
/// statuses -1. After every code but voussoir_ok an earlier evaluation cannot be committed. A call in a forked process
/// or by a note does nothing of this.
int voussoir_evaluate(VoussoirRves* rves, int64_t n, const double* gradients, double* stress, double* tangent,
                      int32_t* status);

/// Makes the state of the last evaluation the committed one, and begins the next increment. misuse unless the last
/// evaluation returned voussoir_ok and nothing was begun, committed or set since.
int voussoir_commit(VoussoirRves* rves);

/// Stress (n, 3) and tangent (n, 3, 3, or NULL) of the committed state [Pa]. The tangent is the one that its evaluation
/// computed, or a stiffer one of the grains' contacts where it computed none.
int voussoir_committed(VoussoirRves* rves, int64_t n, double* stress, double* tangent);

/// Numbers of the last evaluation; misuse before the first one, and after one that was refused or failed with another
/// code than voussoir_no_equilibrium.
int voussoir_report(VoussoirRves* rves, VoussoirReport* report);

/// Size of the committed state [bytes]; it changes with commits, because contacts come and go.
int voussoir_state_size(VoussoirRves* rves, int64_t* size);

/// Writes the committed state into `bytes`, for a file. `size` is what voussoir_state_size says now.
int voussoir_get_state(VoussoirRves* rves, void* bytes, int64_t size);

/// Makes a state that RVEs of the same case, settings, n and version wrote the committed one; the same gradients then
/// give the same bits. wrong_input for other bytes, also where a single bit has changed.
int voussoir_set_state(VoussoirRves* rves, const void* bytes, int64_t size);

/// Number of the named quantities of the committed state (docs/reference/files.md).
int voussoir_field_count(VoussoirRves* rves, int64_t* count);

/// Name, unit and number of components of a quantity; the texts live as long as the process. Each of the last three may
/// be NULL. Index from 0.
int voussoir_field(VoussoirRves* rves, int64_t index, const char** name, const char** unit, int32_t* components);

/// Values (n, components) of a quantity of the committed state.
/// @param name such as "void_ratio"
/// @param size of `values`: n times the number of components
int voussoir_field_values(VoussoirRves* rves, const char* name, double* values, int64_t size);

#ifdef __cplusplus
}
#endif

#endif
