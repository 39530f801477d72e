// The small DEM code as a program: a dump to standard output.
// usage: small_dem_dump CONTACT_TIME_US DURATION_S FRAMES_US SEED [FRICTION]
#include <cstdlib>

#include "small_dem.hpp"

int main(int count, char** words) {
  if (count < 5) return 2;
  small_dem::Deck deck;
  deck.contact_time = std::atof(words[1]) * 1e-6, deck.time_step = deck.contact_time / 50;
  deck.duration = std::atof(words[2]), deck.frames = std::atof(words[3]) * 1e-6;
  deck.seed = static_cast<unsigned>(std::atoi(words[4]));
  if (count > 5) deck.friction = std::atof(words[5]);
  small_dem::Run(deck).write("/dev/stdout");
}
