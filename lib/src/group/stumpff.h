/* Stumpff's functions c_k(s) = sum_j (-s)^j / (2j+k)!:  c_0 = cos x, c_1 = sin x / x, c_2 = (1 - cos x)/x^2, c_3 = (x - sin x)/x^3 with s = x^2. */
#ifndef DVI_GROUP_STUMPFF_H
#define DVI_GROUP_STUMPFF_H

/* c_0 .. c_8 at s >= 0. */
void dvi__stumpff(double s, double c[9]);

#endif
