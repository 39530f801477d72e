// Verdicts as JUnit's XML, which servers of continuous integration show.
#pragma once

#include <string>
#include <string_view>

#include "base/clean_text.hpp"

namespace edmill::io {

class JunitText {
 public:
  /// @param suite  "edmill audit of log.csv"
  explicit JunitText(std::string suite) : suite_(std::move(suite)) {}

  /// A test case. @param problem  what is wrong; none when empty
  void add(std::string_view name, std::string_view problem) {
    ++tests_;
    failures_ += problem.empty() ? 0 : 1;
    text_ += "  <testcase classname=\"edmill\" name=\"" + escaped(name) + "\"";
    text_ +=
        problem.empty() ? "/>\n" : ">\n    <failure message=\"" + escaped(problem) + "\"/>\n  </testcase>\n";
  }

  std::string finish() const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"" + escaped(suite_) +
           "\" tests=\"" + std::to_string(tests_) + "\" failures=\"" + std::to_string(failures_) + "\">\n" +
           text_ + "</testsuite>\n";
  }

 private:
  static std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : clean_text(text))
      out += c == '<'    ? "&lt;"
             : c == '&'  ? "&amp;"
             : c == '"'  ? "&quot;"
             : c == '\n' ? "&#10;"
             : c == '\r' ? "&#13;"
                         : std::string(1, c);
    return out;
  }

  std::string suite_, text_;
  int tests_ = 0, failures_ = 0;
};

}  // namespace edmill::io
