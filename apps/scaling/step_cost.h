/** The cost of a step of a field whose mesh is divided among ranks: a model of few constants, which
 *  are measured, and what it predicts for other numbers of ranks.
 *
 *  A rank moves the bytes of its share through memory, at a constant rate. The share is what it
 *  owns, c cells, and a shell of ghosts around that, together (c^(1/n) + d)^n for a shell of
 *  thickness d. Then it receives messages with the values of s c^((n-1)/n) ghosts. d, s and the
 *  number of messages are those of the rank that has most in cuts of a mesh. They grow with the
 *  number of parts, until parts have neighbours all around, and count as constant beyond the last
 *  cut. Messages are taken one after the other (Hockney 1994): each costs the latency and an
 *  overhead of the program, and its bytes take their time in the network and in being packed. An
 *  agreement of N ranks takes log2 N messages in a row. */
#ifndef STEP_COST_H
#define STEP_COST_H
#include <stdbool.h>

enum { CUTS_MAX = 16 };

/** A cut of a mesh into parts: the most of what one of them has. */
typedef struct mesh_cut {
  double parts;
  double share;    /**< cells of the highest degree, ghosts included */
  double bytes;    /**< that a refresh of the field's form receives */
  double messages; /**< that bring them */
} mesh_cut;

/** The constants. */
typedef struct step_cost {
  int dimension;  /**< n, from 1 to 3 */
  double cells;   /**< n-cells of the mesh that was cut */
  double traffic; /**< bytes that a step moves through memory, for one cell */
  int cuts;
  mesh_cut cut[CUTS_MAX]; /**< [cuts] with ascending parts, from 2 on */
  double per_step,
      per_byte;   /**< seconds of a step in any case, and for a byte moved, of one rank */
  double sharing; /**< factor of these times where other ranks share the memory */
  double latency, bandwidth; /**< of a message: seconds, bytes a second */
  double overhead, packing;  /**< seconds of a message in the program besides, and of a byte */
  double agreements;         /**< of all ranks in a step */
} step_cost;

/** A prediction for the rank that has most. */
typedef struct step_prediction {
  double cells, share;    /**< the mean of cells that a rank owns, and the most with ghosts */
  double messages, bytes; /**< received in a step */
  double compute;         /**< seconds of a step without the others */
  double exchange;        /**< seconds of messages and agreements */
  double seconds;         /**< both */
} step_prediction;

/** Fit seconds = per_step + per_byte bytes to samples [count], so that the squares of relative
 *  deviations are least, and no constant is negative. One sample, or samples of equal size, give
 *  per_byte alone. `deviation` [count] are (fitted - measured)/measured. Returns false, and sets
 *  nothing, if there is no sample, or a number is not positive and finite. */
bool step_cost_fit(int count, const double *bytes, const double *seconds, double *per_step,
                   double *per_byte, double *deviation);

/** Tell if the constants make sense: finite, none negative, and positive where a division or a root
 *  is taken. */
bool step_cost_makes_sense(const step_cost *cost);

/** Predict a step of `cells` n-cells on `ranks`. Returns false, and sets nothing, if the constants
 *  make no sense, or there are more ranks than cells, or a number is not finite or below 1. */
bool step_cost_predict(const step_cost *cost, double ranks, double cells,
                       step_prediction *prediction);

/** Add what takes time to a prediction that has cells, share, messages and bytes. */
void step_cost_charge(const step_cost *cost, double ranks, step_prediction *prediction);
#endif
