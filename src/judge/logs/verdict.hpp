#pragma once

namespace edmill::logs {

/// What every judgement of a log ends with.
enum class Verdict { agree, differ, too_few, not_compared };

}  // namespace edmill::logs
