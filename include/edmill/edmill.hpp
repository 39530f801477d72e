// The whole public interface of edmill; float128 where the compiler has quadmath.h, as GCC does.
#pragma once

#include "edmill/case.hpp"
#include "edmill/contact_law.hpp"
#include "edmill/errors.hpp"
#include "edmill/impact.hpp"
#include "edmill/motion.hpp"
#include "edmill/observer.hpp"
#include "edmill/polynomial.hpp"
#include "edmill/run.hpp"
#include "edmill/summary.hpp"
#include "edmill/version.hpp"
#include "edmill/vessel.hpp"
#if !defined(__x86_64__) || __has_include(<quadmath.h>)
#include "edmill/scalars.hpp"
#endif
