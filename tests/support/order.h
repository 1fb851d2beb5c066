/* Measures orders against the quadruple-precision judge. */
#ifndef SUPPORT_ORDER_H
#define SUPPORT_ORDER_H
/* The problems of an order study: kepler, pendulum, henon-heiles, double-pendulum and toda. Only
 * the double pendulum has no constant mass. */
enum { ORDER_PLACES = 5, DOUBLE_PENDULUM = 3 };

/* Requires that the measured order of a symmetric method on a problem is within 0.2 of `order`. Up
 * to order 6 it is measured by the error at the end of a span, above by the error of one step (see
 * order.c). With DVI_SHOW_ORDERS in the environment the errors are printed. */
void check_order(int place, const char *method, int order);

/* Requires the order on any problem of the catalogue over any span, by the error at its end, from
 * `first` steps on. */
void check_order_over(const char *problem, const char *setting, double length, int first,
                      const char *method, int order);

/* Require an order of 2 or 4, judged by IDA, whose own error of about 1e-10 hides higher orders. */
void check_order_by_ida(int place, const char *method, int order);
void check_order_by_ida_over(const char *problem, const char *setting, double length, int first,
                             const char *method, int order);

#endif
