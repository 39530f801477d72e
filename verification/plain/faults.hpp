// What plain_mill can be made to do wrong.
#pragma once

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

using Options = std::map<std::string, std::string>;

// Mistakes of a code: terms of equations that are larger, smaller, reversed or absent, everywhere
// or in some impacts.
template <class T> class Faults {
 public:
  // Lists with commas: terms, their values, and where.
  explicit Faults(const Options& o) {
    const auto terms = list(o.at("fault")), values = list(o.at("fault-value")),
               places = list(o.at("where"));
    if (terms.size() != values.size() || terms.size() != places.size())
      throw std::runtime_error("a fault needs a value and a place");
    for (std::size_t k = 0; k < terms.size(); ++k)
      faults_.push_back({terms[k], places[k], T(values[k])});
  }

  // What holds of an impact: "wall", "ball", "wall0", "stick", "slide", "slow" (at the least
  // separation speed) and so on.
  void meets(std::vector<std::string> facts) { facts_ = std::move(facts); }
  void also(const std::string& fact) { facts_.push_back(fact); }
  T of(const char* term, const T& right = T(1)) const {
    for (const Fault& f : faults_)
      if (f.term == term &&
          (f.where == "all" || std::find(facts_.begin(), facts_.end(), f.where) != facts_.end()))
        return f.value;
    return right;
  }
 private:
  struct Fault {
    std::string term, where;
    T value;
  };
  static std::vector<std::string> list(const std::string& text) {
    std::vector<std::string> words;
    std::string word;
    for (std::istringstream in(text); std::getline(in, word, ',');) words.push_back(word);
    return words;
  }
  std::vector<Fault> faults_;
  std::vector<std::string> facts_;
};
