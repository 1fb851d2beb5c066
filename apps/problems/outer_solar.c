/* The outer solar system: the Sun (with the inner planets' mass) and five bodies; lengths in AU, times in days, masses in suns.
 * The start is that of September 5, 1994 (Hairer, Lubich and Wanner 2006, sec. I.2.4). */
#include "entry.h"
#include "nbody.h"

static const nbody bodies = {
    .bodies = 6,
    .dimension = 3,
    .G = 2.95912208286e-4,
    .mass = {0.000954786104043, 0.000285583733151, 0.0000437273164546, 0.0000517759138449, 1.0 / 1.3e8, 1.00000597682},
    .name = {"jupiter", "saturn", "uranus", "neptune", "pluto", "sun"},
    .position = {{-3.5023653, -3.8169847, -1.5507963},
                 {9.0755314, -3.0458353, -1.6483708},
                 {8.3101420, -16.2901086, -7.2521278},
                 {11.4707666, -25.7294829, -10.8169456},
                 {-15.5387357, -25.2225594, -3.1902382},
                 {0.0, 0.0, 0.0}},
    .velocity = {{0.00565429, -0.00412490, -0.00190589},
                 {0.00168318, 0.00483525, 0.00192462},
                 {0.00354178, 0.00137102, 0.00055029},
                 {0.00288930, 0.00114527, 0.00039677},
                 {0.00276725, -0.00170702, -0.00136504},
                 {0.0, 0.0, 0.0}},
};

static dvi_status make(const double *setting, problem *made)
{
  (void)setting;
  return nbody_make(&bodies, made);
}

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    4.7616886218133673,   -1.4985316562061407,   -0.75853432347025402,  7.0843466396727545,  -6.3784134214123005,
    -2.9393716783127347,  14.397421886207614,    12.442139480455788,    5.2450098068129851,  29.695174558793546,
    -3.4839995619102974,  -2.1661666884938798,   15.237592115586662,    -27.948052013040140, -13.299424850200689,
    0.053306088172255331, -0.028052803944459499, -0.013636778775970180,
};
static const double digits_p[] = {
    2.2963818590244320e-6, 6.5803571921779500e-6,    2.7646380364794613e-6,  1.0363258513139691e-6,  1.0567361373945014e-6,
    3.9185903340268607e-7, -1.1905922711619661e-7,   1.0648543592908385e-7,  4.8318508670187414e-8,  2.1118703018299752e-8,
    1.5004178630296408e-7, 6.0883451449491226e-8,    2.2306895306949271e-11, 7.7501418982146783e-12, -4.2915832188607443e-12,
    2.9490268243416877e-6, -0.000010331921461463338, -4.4911765277556923e-6,
};

const problem_entry problem_entry_outer_solar = {
    .name = "outer-solar",
    .summary = "the Sun, Jupiter, Saturn, Uranus, Neptune and Pluto; AU and days",
    .make = make,
    .h = 100.0,
    .t_end = 500000.0,
    .order_h = 100.0,
    .order_t_end = 10000.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
