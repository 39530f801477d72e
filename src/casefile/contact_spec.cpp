#include "casefile/case_parts.hpp"

namespace edmill::casefile {

using boost::multiprecision::cpp_rational;

namespace {

/// Reads the keys that are there; what is absent keeps the value that `spec` came with.
/// A new contact law adds its name and its keys here and its formula in model/contact_law.hpp.
struct ContactKeys {
  bool restitution = false, tangential = false, friction = false;
};
void read_contact_keys(Section& s, ContactSpec& spec, ContactKeys& given) {
  using model::ContactModel;
  if (s.has("model"))
    spec.model = s.choice("model", {"walton-braun", "constant"}) == "constant" ? ContactModel::constant
                                                                               : ContactModel::walton_braun;
  else
    s.choice("model", {"walton-braun", "constant"});
  const auto take = [&](const std::string& key, const cpp_rational& low, const cpp_rational& high,
                        Quantity& value, bool& was_given, const std::string& expected) {
    const bool here = s.has(key);
    if (const auto found = s.quantity(key, Dimension::none)) {
      value = *found;
      s.require(value.value >= low && value.value <= high, key, expected);
    }
    was_given = was_given || here;
  };
  const cpp_rational large = cpp_rational(1000000);
  bool ignored = false;
  if (s.has("restitution") && s.has("restitution_normal"))
    s.problem("restitution_normal", "both 'restitution' and 'restitution_normal'", "one of them");
  take("restitution", 0, 1, spec.restitution_normal, given.restitution, "a number from 0 to 1");
  take("restitution_normal", 0, 1, spec.restitution_normal, given.restitution, "a number from 0 to 1");
  take("restitution_tangential", -1, 1, spec.restitution_tangential, given.tangential,
       "a number from -1 to 1");
  take("friction", 0, large, spec.friction, given.friction, "a number from 0 to 1000000");
  take("min_tangential", -1, 1, spec.min_tangential, ignored, "a number from -1 to 1");
  if (const auto speed = s.quantity("least_separation", Dimension::speed)) {
    spec.least_separation = *speed;
    s.require(!speed->negative(), "least_separation", "a speed of 0 or more");
  }
  s.replaced("collapse_time", "'least_separation', the least speed at which bodies leave an impact");
}

}  // namespace

void read_contact(Section contact, CaseSpec& spec) {
  ContactSpec base;
  ContactKeys base_given;
  read_contact_keys(contact, base, base_given);
  for (const bool balls : {true, false}) {
    Section own = contact.section(balls ? "ball_ball" : "ball_wall");
    ContactSpec& law = balls ? spec.ball_ball : spec.ball_wall;
    ContactKeys given = base_given;
    law = base;
    read_contact_keys(own, law, given);
    own.reject_unknown_keys();
    const auto need = [&](bool there, const std::string& key, const std::string& expected) {
      if (!there) contact.problem(key, "nothing", expected);
    };
    need(given.restitution, "restitution", "a number from 0 to 1");
    if (law.model == model::ContactModel::constant)
      need(given.tangential, "restitution_tangential", "a number from -1 to 1");
    else
      need(given.friction, "friction", "a number from 0 to 1000000");
  }
  contact.reject_unknown_keys();
}

}  // namespace edmill::casefile
