/* Three equal masses that chase each other along one figure eight (Chenciner and Montgomery 2000),
 * with the period 6.32591398. Simo's start has eight digits, so that the orbit closes to 3e-8. */
#include "entry.h"
#include "nbody.h"

static const nbody bodies = {
    .bodies = 3,
    .dimension = 2,
    .G = 1.0,
    .mass = {1.0, 1.0, 1.0},
    .name = {"1", "2", "3"},
    .position = {{0.97000436, -0.24308753}, {-0.97000436, 0.24308753}, {0.0, 0.0}},
    .velocity = {{0.466203685, 0.432365730},
                 {0.466203685, 0.432365730},
                 {-0.93240737, -0.86473146}},
};

static dvi_status figure_eight_make(const double *setting, problem *made)
{
  (void)setting;
  return nbody_make(&bodies, made);
}

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    -1.0809256306663230, -0.0074896189951733085, 0.55804605782713226,
    0.34872902585899099, 0.52287957283919077,    -0.34123940686381769,
};
static const double digits_p[] = {
    -0.011411541552956665, 0.46721292709810324, -1.0906310090220546,
    -0.19879848451765548,  1.1020425505750112,  -0.26841444258044777,
};

const problem_entry problem_entry_figure_eight = {
    .name = "figure-eight",
    .summary = "three equal masses on one figure eight; periodic",
    .make = figure_eight_make,
    .h = 0.02,
    .t_end = 6.32591398,
    .order_h = 0.05,
    .order_t_end = 10.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
