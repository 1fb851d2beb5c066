/* Three equal masses that chase each other along one figure eight (Chenciner and Montgomery 2000); period 6.32591398. Simo's start
 * has eight digits: the orbit closes to 3e-8. */
#include "entry.h"
#include "nbody.h"

static const nbody bodies = {
    .bodies = 3,
    .dimension = 2,
    .G = 1.0,
    .mass = {1.0, 1.0, 1.0},
    .name = {"1", "2", "3"},
    .position = {{0.97000436, -0.24308753}, {-0.97000436, 0.24308753}, {0.0, 0.0}},
    .velocity = {{0.466203685, 0.432365730}, {0.466203685, 0.432365730}, {-0.93240737, -0.86473146}},
};

static dvi_status make(const double *setting, problem *made)
{
  (void)setting;
  return nbody_make(&bodies, made);
}

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    0.99358291994097785,  0.21920494711469556,  -0.050734285274952345,
    0.046861246685958620, -0.94284863466602551, -0.26606619380065418,
};
static const double digits_p[] = {
    -0.40274888606138358, 0.44609770284964567, 0.93719190869812844, -0.85864218523816799, -0.53444302263674486, 0.41254448238852232,
};

const problem_entry problem_entry_figure_eight = {
    .name = "figure-eight",
    .summary = "three equal masses on one figure eight; periodic",
    .make = make,
    .h = 0.02,
    .t_end = 6.32591398,
    .order_h = 0.05,
    .order_t_end = 1.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
