/* Loops over rows of any length by the functions of num/simd/each_width.h, which return where they
 * stop. ALL makes whole vectors of the target's width first, the rest in shorter ones. */
#ifndef DVI_NUM_SIMD_TAILS_H
#define DVI_NUM_SIMD_TAILS_H

#define TAIL2(name, ...) name##2(__VA_ARGS__, 0)
#define TAIL4(name, ...) name##2(__VA_ARGS__, name##4(__VA_ARGS__, 0))
#define TAIL8(name, ...) name##2(__VA_ARGS__, name##4(__VA_ARGS__, name##8(__VA_ARGS__, 0)))
#define ALL(width, name, ...) ((void)name##1(__VA_ARGS__, TAIL##width(name, __VA_ARGS__)))

#endif
