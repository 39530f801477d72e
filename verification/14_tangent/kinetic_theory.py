"""The largest Lyapunov exponent of a gas of hard spheres by kinetic theory: Boltzmann's equation by
direct simulation (Bird), in which balls have velocities and no places, with a direction of the
tangent space that flies and collides (Ch. Dellago and H. A. Posch, Physica A 240, 68, 1997,
simulate so, too). It has no code of edmill. Diameter and mass are 1."""
import math
import random


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def plus(a, factor, b):
    return [x + factor * y for x, y in zip(a, b)]


class Gas:
    def __init__(self, balls, density, seed):
        self.draw = random.Random(seed)
        self.balls = balls
        self.v = [self.vector() for _ in range(balls)]
        drift = [sum(v[c] for v in self.v) / balls for c in range(3)]
        self.v = [plus(v, -1, drift) for v in self.v]
        # A direction nearby: of places and of velocities, each place at the time of its ball's last
        # collision.
        self.of_place = [self.vector() for _ in range(balls)]
        self.of_velocity = [self.vector() for _ in range(balls)]
        self.at = [0.0] * balls
        self.time = 0.0
        # Pairs are proposed at the rate of this relative speed, which none exceeds, and collide by
        # their own.
        self.fastest = 8 * math.sqrt(sum(dot(v, v) for v in self.v) / (3 * balls))
        self.rate = (balls - 1) / 2 * math.pi * density * self.fastest

    def vector(self):
        return [self.draw.gauss(0, 1) for _ in range(3)]

    def fly(self, ball):
        self.of_place[ball] = plus(self.of_place[ball], self.time - self.at[ball],
                                   self.of_velocity[ball])
        self.at[ball] = self.time

    def collide(self):
        """The next collision of any two."""
        while True:
            self.time += self.draw.expovariate(self.rate)
            i, j = self.draw.sample(range(self.balls), 2)
            g = plus(self.v[j], -1, self.v[i])
            speed = math.sqrt(dot(g, g))
            if self.draw.random() * self.fastest < speed:
                return self.impact(i, j, g, speed)

    def normal(self, g, speed):
        """From one ball to the other where they touch: the point is uniform on the disc that a beam
        sees."""
        along = [x / speed for x in g]
        across = self.vector()
        across = plus(across, -dot(across, along), along)
        b = math.sqrt(self.draw.random())
        return plus([-math.sqrt(1 - b * b) * x for x in along], b / math.sqrt(dot(across, across)),
                    across)

    def impact(self, i, j, g, speed):
        n = self.normal(g, speed)
        self.fly(i)
        self.fly(j)
        q, w = plus(self.of_place[j], -1, self.of_place[i]), plus(self.of_velocity[j], -1,
                                                                  self.of_velocity[i])
        gn, qn, wn = dot(g, n), dot(q, n), dot(w, n)
        turned = plus(q, -qn / gn, g)  # of the normal, with the delay of the impact
        change = plus([(wn + dot(g, turned)) * x for x in n], gn, turned)
        for ball, sign in ((i, 1), (j, -1)):
            self.v[ball] = plus(self.v[ball], sign * gn, n)
            self.of_place[ball] = plus(self.of_place[ball], sign * qn, n)
            self.of_velocity[ball] = plus(self.of_velocity[ball], sign, change)

    def stretched(self):
        """The logarithm of the length of the direction, which becomes 1."""
        for ball in range(self.balls):
            self.fly(ball)
        length = math.sqrt(sum(dot(d, d) for d in self.of_place + self.of_velocity))
        self.of_place = [[x / length for x in d] for d in self.of_place]
        self.of_velocity = [[x / length for x in d] for d in self.of_velocity]
        return math.log(length)


def largest_exponent(balls, density, collisions, seed):
    """Over the collisions of a ball, of which those of a first tenth are left out. @param density
    balls per cubed diameter"""
    gas, sum_of, every = Gas(balls, density, seed), 0, 50
    for k in range(collisions // every):
        for _ in range(every):
            gas.collide()
        grown = gas.stretched()
        if k * every >= collisions // 10:
            sum_of += grown
    counted = every * sum(1 for k in range(collisions // every) if k * every >= collisions // 10)
    return sum_of / (2 * counted / balls)
