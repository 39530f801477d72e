// check_certificate FILE: exit code 0 "accepted", 1 "rejected" with the event and the rule, 2 for what is no certificate.
#include <fstream>
#include <iostream>

#include "check.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return std::cerr << "usage: check_certificate FILE\n", 2;
  try {
    std::ifstream file(argv[1]);
    if (!file) throw std::runtime_error("cannot be opened");
    std::cout << checker::check(file) << "\n";
    return 0;
  } catch (const checker::Rejected& why) {
    return std::cout << "rejected: " << why.what() << "\n", 1;
  } catch (const std::exception& error) {
    return std::cerr << "check_certificate: " << argv[1] << ": " << error.what() << "\n", 2;
  }
}
