/* SUNDIALS as the library calls it: by a table of its functions.
 *
 * The shared library loads SUNDIALS when a solver first asks for it (sundials_loaded.c). Some
 * builds of SUNDIALS bring MPI along, whose start takes longer than most runs. The static library
 * is linked to it (sundials_linked.c). Names of SUNDIALS' functions stand for members of the table
 * in the files that include this header. The shared library does not link if one is missing. */
#ifndef DVI_SOLVE_SUNDIALS_H
#define DVI_SOLVE_SUNDIALS_H
#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <dvi/status.h>
#include <ida/ida.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "solve/sundials_compat.h"

typedef struct dvi__sundials_table {
  int (*new_context)(SUNContext *context); /* silent. 0 on success, then SUNContext_Free frees it */
#define FUNCTION(name) __typeof__(name) *name;
#define FUNCTION_OF(name, function) __typeof__(function) *name;
#include "solve/sundials.def"
#undef FUNCTION
#undef FUNCTION_OF
} dvi__sundials_table;

/* The table of a SUNDIALS that is linked, and the one that is used, NULL before it is loaded. */
extern const dvi__sundials_table dvi__sundials_linked;
extern const dvi__sundials_table *dvi__sundials;

/* Load SUNDIALS, if that has not been done. Must come before any other call of it. */
dvi_status dvi__sundials_load(void);

#ifndef DVI__SUNDIALS_IS_LINKED
#define ARKStepCreate dvi__sundials->ARKStepCreate
#define ARKStepSetErrHandlerFn dvi__sundials->ARKStepSetErrHandlerFn
#define ARKStepSetTableNum dvi__sundials->ARKStepSetTableNum
#define ARKodeEvolve dvi__sundials->ARKodeEvolve
#define ARKodeFree dvi__sundials->ARKodeFree
#define ARKodeGetCurrentTime dvi__sundials->ARKodeGetCurrentTime
#define ARKodeGetNumSteps dvi__sundials->ARKodeGetNumSteps
#define ARKodeGetReturnFlagName dvi__sundials->ARKodeGetReturnFlagName
#define ARKodeSStolerances dvi__sundials->ARKodeSStolerances
#define ARKodeSetMaxNumSteps dvi__sundials->ARKodeSetMaxNumSteps
#define ARKodeSetMinStep dvi__sundials->ARKodeSetMinStep
#define ARKodeSetStopTime dvi__sundials->ARKodeSetStopTime
#define ARKodeSetUserData dvi__sundials->ARKodeSetUserData
#define CVode dvi__sundials->CVode
#define CVodeCreate dvi__sundials->CVodeCreate
#define CVodeFree dvi__sundials->CVodeFree
#define CVodeGetCurrentTime dvi__sundials->CVodeGetCurrentTime
#define CVodeGetNumSteps dvi__sundials->CVodeGetNumSteps
#define CVodeGetReturnFlagName dvi__sundials->CVodeGetReturnFlagName
#define CVodeInit dvi__sundials->CVodeInit
#define CVodeSStolerances dvi__sundials->CVodeSStolerances
#define CVodeSetErrHandlerFn dvi__sundials->CVodeSetErrHandlerFn
#define CVodeSetJacFn dvi__sundials->CVodeSetJacFn
#define CVodeSetLinearSolver dvi__sundials->CVodeSetLinearSolver
#define CVodeSetMaxNumSteps dvi__sundials->CVodeSetMaxNumSteps
#define CVodeSetMinStep dvi__sundials->CVodeSetMinStep
#define CVodeSetNonlinearSolver dvi__sundials->CVodeSetNonlinearSolver
#define CVodeSetStopTime dvi__sundials->CVodeSetStopTime
#define CVodeSetUserData dvi__sundials->CVodeSetUserData
#define IDACreate dvi__sundials->IDACreate
#define IDAFree dvi__sundials->IDAFree
#define IDAGetCurrentTime dvi__sundials->IDAGetCurrentTime
#define IDAGetNumSteps dvi__sundials->IDAGetNumSteps
#define IDAGetReturnFlagName dvi__sundials->IDAGetReturnFlagName
#define IDAInit dvi__sundials->IDAInit
#define IDASStolerances dvi__sundials->IDASStolerances
#define IDASVtolerances dvi__sundials->IDASVtolerances
#define IDASetErrHandlerFn dvi__sundials->IDASetErrHandlerFn
#define IDASetId dvi__sundials->IDASetId
#define IDASetJacFn dvi__sundials->IDASetJacFn
#define IDASetLinearSolver dvi__sundials->IDASetLinearSolver
#define IDASetMaxNumSteps dvi__sundials->IDASetMaxNumSteps
#define IDASetMinStep dvi__sundials->IDASetMinStep
#define IDASetStopTime dvi__sundials->IDASetStopTime
#define IDASetSuppressAlg dvi__sundials->IDASetSuppressAlg
#define IDASetUserData dvi__sundials->IDASetUserData
#define IDASolve dvi__sundials->IDASolve
#define KINCreate dvi__sundials->KINCreate
#define KINFree dvi__sundials->KINFree
#define KINGetFuncNorm dvi__sundials->KINGetFuncNorm
#define KINGetNumNonlinSolvIters dvi__sundials->KINGetNumNonlinSolvIters
#define KINInit dvi__sundials->KINInit
#define KINSetErrHandlerFn dvi__sundials->KINSetErrHandlerFn
#define KINSetEtaConstValue dvi__sundials->KINSetEtaConstValue
#define KINSetEtaForm dvi__sundials->KINSetEtaForm
#define KINSetFuncNormTol dvi__sundials->KINSetFuncNormTol
#define KINSetJacFn dvi__sundials->KINSetJacFn
#define KINSetJacTimesVecFn dvi__sundials->KINSetJacTimesVecFn
#define KINSetLinearSolver dvi__sundials->KINSetLinearSolver
#define KINSetMaxNewtonStep dvi__sundials->KINSetMaxNewtonStep
#define KINSetMaxSetupCalls dvi__sundials->KINSetMaxSetupCalls
#define KINSetNoMinEps dvi__sundials->KINSetNoMinEps
#define KINSetNumMaxIters dvi__sundials->KINSetNumMaxIters
#define KINSetScaledStepTol dvi__sundials->KINSetScaledStepTol
#define KINSetUserData dvi__sundials->KINSetUserData
#define KINSol dvi__sundials->KINSol
#define N_VClone dvi__sundials->N_VClone
#define N_VConst dvi__sundials->N_VConst
#define N_VDestroy dvi__sundials->N_VDestroy
#define N_VGetArrayPointer dvi__sundials->N_VGetArrayPointer
#define N_VLinearSum dvi__sundials->N_VLinearSum
#define N_VNew_Serial dvi__sundials->N_VNew_Serial
#define N_VScale dvi__sundials->N_VScale
#define SUNContext_Free dvi__sundials->SUNContext_Free
#define SUNDenseMatrix dvi__sundials->SUNDenseMatrix
#define SUNLinSolFree dvi__sundials->SUNLinSolFree
#define SUNLinSolFreeEmpty dvi__sundials->SUNLinSolFreeEmpty
#define SUNLinSolInitialize dvi__sundials->SUNLinSolInitialize
#define SUNLinSolNewEmpty dvi__sundials->SUNLinSolNewEmpty
#define SUNLinSol_Dense dvi__sundials->SUNLinSol_Dense
#define SUNLinSol_KLU dvi__sundials->SUNLinSol_KLU
#define SUNLinSol_SPGMR dvi__sundials->SUNLinSol_SPGMR
#define SUNLinSol_SPGMRSetMaxRestarts dvi__sundials->SUNLinSol_SPGMRSetMaxRestarts
#define SUNMatDestroy dvi__sundials->SUNMatDestroy
#define SUNMatFreeEmpty dvi__sundials->SUNMatFreeEmpty
#define SUNMatGetID dvi__sundials->SUNMatGetID
#define SUNMatNewEmpty dvi__sundials->SUNMatNewEmpty
#define SUNNonlinSolFree dvi__sundials->SUNNonlinSolFree
#define SUNNonlinSol_FixedPoint dvi__sundials->SUNNonlinSol_FixedPoint
#define SUNSparseMatrix dvi__sundials->SUNSparseMatrix
#endif

#endif
