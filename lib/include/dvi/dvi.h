/** libdvi: discrete variational mechanics. This header includes all the others except
 * dvi/scene.h, which belongs to the library of scenes. */
#ifndef DVI_DVI_H
#define DVI_DVI_H
#include <dvi/audit.h>
#include <dvi/basis.h>
#include <dvi/contact.h>
#include <dvi/control.h>
#include <dvi/density.h>
#include <dvi/diagnostics.h>
#include <dvi/ensemble.h>
#include <dvi/field.h>
#include <dvi/forms.h>
#include <dvi/group.h>
#include <dvi/integrator.h>
#include <dvi/joint.h>
#include <dvi/march.h>
#include <dvi/matrix.h>
#include <dvi/maxwell.h>
#include <dvi/mesh.h>
#include <dvi/method.h>
#include <dvi/noise.h>
#include <dvi/number.h>
#include <dvi/path.h>
#include <dvi/quadrature.h>
#include <dvi/reference.h>
#include <dvi/run.h>
#include <dvi/sensitivity.h>
#include <dvi/shapes.h>
#include <dvi/space.h>
#include <dvi/spectrum.h>
#include <dvi/status.h>
#include <dvi/system.h>
#include <dvi/taylor.h>
#include <dvi/transform.h>
#include <dvi/version.h>
#include <dvi/yee.h>
#endif
