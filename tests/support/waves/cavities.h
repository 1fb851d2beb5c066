/* Frequencies of cavities with walls that conduct perfectly. The speed of light is 1. All lists are
 * ascending, and name a frequency as often as it has modes. */
#ifndef SUPPORT_WAVES_CAVITIES_H
#define SUPPORT_WAVES_CAVITIES_H

/* The frequencies of a box. */
void cavity_box(const double side[3], int count, double *frequency);

/* The frequencies of a cylinder: TM_mnp has j_mn/R and p half waves along the axis, p >= 0, and
 * TE_mnp j'_mn/R, p >= 1 (Jackson 1999, sec. 8.7). */
void cavity_cylinder(double radius, double length, int count, double *frequency);

/* The frequencies of a sphere: j_n(kR) = 0 (TE), and (x j_n(x))' = 0 at x = kR (TM), 2n+1 modes
 * each (Jackson 1999, sec. 9.6). */
void cavity_sphere(double radius, int count, double *frequency);

/* The frequencies of TM waves in a disk, j_mn/R, those of a drum. */
void cavity_disk(double radius, int count, double *frequency);

#endif
