#pragma once

namespace edmill::logs {

/// The result of every judgement of a log.
enum class Verdict { agree, differ, too_few, not_compared };

}  // namespace edmill::logs
