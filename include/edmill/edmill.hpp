// The whole public interface of edmill.
#pragma once

#include "edmill/case.hpp"
#include "edmill/contact_law.hpp"
#include "edmill/errors.hpp"
#include "edmill/impact.hpp"
#include "edmill/motion.hpp"
#include "edmill/observer.hpp"
#include "edmill/polynomial.hpp"
#include "edmill/run.hpp"
#include "edmill/scalars.hpp"
#include "edmill/summary.hpp"
#include "edmill/version.hpp"
#include "edmill/vessel.hpp"
