#include "core/numerics/formulas/metric_formula.h"

DRAPE_METRIC(height, "Height of a state's lowest point.", "m", neither) { return x.col(2).minCoeff(); }
