/* Uses the installed library of studies: a spread and a fit, and the sentence on missing runs. */
#include <dvi/study.h>
#include <string.h>

int main(void)
{
  double sample[] = {3, 1, 2};
  const double h[] = {1, 0.5, 0.25, 0.125}, error[] = {1, 0.25, 0.0625, 0.015625};
  dvi_order_fit fit;
  const int settled = dvi_study_fit(4, h, error, 0.0, 2.0, &fit);
  return settled && dvi_study_spread_of(3, sample).median == 2 &&
                 dvi_study_work(NULL, NULL, 0, NULL, 1) == DVI_BAD_ARGUMENT &&
                 strstr(dvi_last_error(), "study") != NULL
             ? 0
             : 1;
}
