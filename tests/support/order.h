/* Measuring orders against the quadruple-precision judge. */
#ifndef SUPPORT_ORDER_H
#define SUPPORT_ORDER_H
/* The places of the acceptance: kepler, pendulum, henon-heiles, double-pendulum and toda. Only the
 * double pendulum has no constant mass. */
enum { ORDER_PLACES = 5, DOUBLE_PENDULUM = 3 };

/* The measured order of a symmetric method at a place must be within 0.2 of `order`: up to order 6
 * by the error at the end of a span, above by the error of one step (see order.c). With
 * DVI_SHOW_ORDERS in the environment the errors are printed. */
void check_order(int place, const char *method, int order);

/* The same on another problem over another span, by the error at its end, from `first` steps on. */
void check_order_over(const char *problem, const char *setting, double length, int first,
                      const char *method, int order);

/* The same for orders that IDA's own error of about 1e-10 allows to be seen: 2 and 4. */
void check_order_by_ida(int place, const char *method, int order);
void check_order_by_ida_over(const char *problem, const char *setting, double length, int first,
                             const char *method, int order);

#endif
