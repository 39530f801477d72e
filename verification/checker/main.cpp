// check_certificate FILE
// Exit code 0: "accepted". 1: "rejected", with the event and the rule. 2: what is no certificate.
#include <fstream>
#include <iostream>

#include "check.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: check_certificate FILE\n";
    return 2;
  }
  try {
    std::ifstream file(argv[1]);
    if (!file) throw std::runtime_error("cannot be opened");
    std::cout << checker::check(file) << "\n";
    return 0;
  } catch (const checker::Rejected& why) {
    std::cout << "rejected: " << why.what() << "\n";
    return 1;
  } catch (const std::exception& error) {
    std::cerr << "check_certificate: " << argv[1] << ": " << error.what() << "\n";
    return 2;
  }
}
