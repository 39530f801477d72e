#include "io/facts.hpp"

#include <algorithm>
#include <cmath>

namespace edmill::io {

namespace {

/// "energy/closure": "energy" and "closure".
Facts::Texts parts_of(const std::string& path) {
  Facts::Texts parts{""};
  for (const char c : path)
    if (c == '/')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

}  // namespace

void Facts::set(const std::string& path, Value value) {
  for (auto& [known, old] : values_)
    if (known == path) {
      old = std::move(value);
      return;
    }
  values_.emplace_back(path, std::move(value));
}

const Facts::Value* Facts::value(std::string_view path) const {
  for (const auto& [known, value] : values_)
    if (known == path) return &value;
  return nullptr;
}

std::optional<double> Facts::find(std::string_view path) const {
  const auto* found = value(path);
  if (!found || std::holds_alternative<std::monostate>(*found)) return std::nullopt;
  const double number = this->number(path);
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

Facts::Texts Facts::keys_of(const std::string& group) const {
  Texts keys;
  for (const auto& [path, value] : values_) {
    if (!path.starts_with(group + "/")) continue;
    const auto key =
        path.substr(group.size() + 1, path.find('/', group.size() + 1) - group.size() - 1);
    if (keys.empty() || keys.back() != key) keys.push_back(key);
  }
  return keys;
}

InputError Facts::wrong(std::string_view path, const char* expected) const {
  const auto* found = value(path);
  std::string key(path);
  std::replace(key.begin(), key.end(), '/', '.');
  const auto shown = found ? "found " +
          std::visit([](const auto& held) { return JsonText::of(held); }, *found).substr(0, 40)
                           : "missing";
  return InputError(source_ + ": " + key + ": " + shown + ", expected " + expected);
}

std::string Facts::json() const {
  JsonText json;
  Texts open;  // groups
  for (const auto& [path, value] : values_) {
    const auto parts = parts_of(path);
    const auto common = static_cast<std::size_t>(
        std::mismatch(open.begin(), open.end(), parts.begin(), parts.end() - 1).first -
        open.begin());
    for (; open.size() > common; open.pop_back()) json.end();
    for (auto k = common; k + 1 < parts.size(); ++k) json.begin(open.emplace_back(parts[k]));
    std::visit([&](const auto& held) { json.add(parts.back(), held); }, value);
  }
  for (; !open.empty(); open.pop_back()) json.end();
  return json.finish();
}

}  // namespace edmill::io
