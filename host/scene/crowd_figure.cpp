#include "gnomon/scene/crowd_figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace gnomon {
namespace {

// Elbow and hand as offsets from the shoulder, for the right arm (+x); the left one is mirrored.
struct Arm {
  Point elbow;
  Point hand;
};

struct Stance {
  Arm right;
  Arm left;
  double stride;  // of the right foot forwards, the left one backwards
};

Stance stance_of(Pose pose, SteadyRandom& random) {
  const Arm hanging{{0.06, -0.28, -0.02}, {0.08, -0.53, 0.05}};
  const Arm raised{{0.12, 0.2, 0.06}, {0.14, 0.47, 0.1}};
  const double sway = random.between(-0.05, 0.05);
  Stance stance{hanging, hanging, sway};
  switch (pose) {
    case Pose::kWalking:
      stance.stride = random.chance(0.5) ? 0.24 : -0.24;
      stance.right = {{0.05, -0.27, -0.5 * stance.stride}, {0.05, -0.5, -0.6 * stance.stride + 0.08}};
      stance.left = {{0.05, -0.27, 0.5 * stance.stride}, {0.05, -0.5, 0.6 * stance.stride + 0.08}};
      break;
    case Pose::kCheering:
      stance.right = raised;
      stance.left = {{0.16, 0.16, 0.02}, {0.24 + sway, 0.42, 0.05}};
      break;
    case Pose::kWaving:
      stance.right = {{0.2, 0.08, 0.05}, {0.22 + sway, 0.36, 0.08}};
      break;
    case Pose::kClapping:
      stance.right = {{0.08, -0.22, 0.12}, {-0.13, -0.12 + sway, 0.34}};
      stance.left = stance.right;
      break;
    case Pose::kHandsOnHips:
      stance.right = {{0.24, -0.24, -0.04}, {0.02, -0.4, 0.05}};
      stance.left = stance.right;
      break;
    default:
      break;
  }
  return stance;
}

// What every part of one figure shares. Lengths are shares of the body height, scaled by the frame.
struct Figure {
  MeshSketch& sketch;
  Frame frame;
  double scale;
  unsigned sides;
  unsigned rings;

  [[nodiscard]] Point at(const Point& p) const { return frame.at(scale * p.x, scale * p.y, scale * p.z); }
  void limb(const Point& from, const Point& to, double radius_from, double radius_to) const {
    sketch.limb(at(from), at(to), scale * radius_from, scale * radius_to, sides, rings);
  }
  void ball(const Point& middle, const Point& radii) const {
    Frame place = frame;
    place.origin = at(middle);
    sketch.ellipsoid(place, scale * radii, sides, rings);
  }
  // A body of elliptical rings about the y axis: (half width, half depth, height).
  void trunk(std::initializer_list<Point> knots) const {
    const unsigned steps = std::max(1U, rings / 4);
    std::vector<Point> sections;
    for (const Point* k = knots.begin(); k + 1 < knots.end(); ++k) {
      for (unsigned i = 0; i < steps; ++i) {
        const double t = static_cast<double>(i) / steps;
        sections.push_back(*k + t * t * (3.0 - 2.0 * t) * (*(k + 1) - *k));
        sections.back().z = k->z + t * ((k + 1)->z - k->z);
      }
    }
    sections.push_back(*(knots.end() - 1));
    sketch.sheet(
        sides, static_cast<unsigned>(sections.size() - 1),
        [&](unsigned i, unsigned j) {
          const double turns = static_cast<double>(i) / sides;
          const Point& s = sections[j];
          return at({s.x * cos_turns(turns), s.z, -s.y * sin_turns(turns)});
        },
        Rim::kClosed);
  }
};

void draw_arm(const Figure& figure, const Arm& arm, double side, const Outfit& outfit) {
  const Point shoulder{side * 0.105, 0.8, 0.0};
  const auto mirrored = [&](const Point& p) { return shoulder + 0.57 * Point{side * p.x, p.y, p.z}; };
  const Point elbow = mirrored(arm.elbow);
  const Point hand = mirrored(arm.hand);
  figure.sketch.use(outfit.top);
  figure.limb(shoulder, elbow, 0.03, 0.024);
  figure.sketch.use(outfit.skin);
  figure.limb(elbow, hand, 0.023, 0.017);
  figure.ball(hand + 0.2 * (hand - elbow), {0.016, 0.028, 0.02});
}

void draw_leg(const Figure& figure, double side, double stride, const Outfit& outfit) {
  const Point hip{side * 0.05, 0.5, 0.0};
  const Point ankle{side * 0.055, 0.045, 0.57 * stride};
  const Point knee = 0.5 * (hip + ankle) + Point{0.0, 0.0, 0.02 + 0.15 * std::abs(stride)};
  figure.sketch.use(outfit.skirt ? outfit.skin : outfit.legs);
  figure.limb(hip, knee, 0.05, 0.035);
  figure.limb(knee, ankle, 0.035, 0.022);
  figure.sketch.use(outfit.shoes);
  figure.limb(ankle + Point{0.0, -0.02, -0.01}, ankle + Point{side * 0.012, -0.027, 0.08}, 0.025, 0.018);
}

void draw_head(const Figure& figure, const Outfit& outfit) {
  figure.sketch.use(outfit.skin);
  figure.limb({0.0, 0.82, 0.0}, {0.0, 0.88, 0.008}, 0.03, 0.027);
  figure.ball({0.0, 0.935, 0.012}, {0.043, 0.062, 0.05});
  figure.ball({0.0, 0.927, 0.062}, {0.008, 0.012, 0.012});
  figure.sketch.use(outfit.hair);
  figure.ball({0.0, 0.952, -0.004}, {0.048, 0.052, 0.052});
  for (const double side : {-1.0, 1.0}) figure.ball({side * 0.018, 0.942, 0.057}, {0.006, 0.005, 0.005});
}

}  // namespace

void draw_figure(MeshSketch& sketch, SteadyRandom& random, const Frame& foot, double height, Pose pose,
                 const Outfit& outfit, double triangles) {
  // Twenty parts of 2 sides (rings - 1) triangles with rings at 0.8 sides.
  const unsigned sides = at_least(4, std::sqrt(triangles / (20.0 * 1.6)) + 0.5);
  const Figure figure{sketch, foot, height, sides, std::max(3U, (4 * sides + 2) / 5)};
  const Stance stance = stance_of(pose, random);
  draw_leg(figure, 1.0, stance.stride, outfit);
  draw_leg(figure, -1.0, -stance.stride, outfit);
  sketch.use(outfit.legs);
  if (outfit.skirt) {
    figure.trunk(
        {{0.0, 0.0, 0.27}, {0.135, 0.12, 0.27}, {0.1, 0.085, 0.5}, {0.075, 0.06, 0.62}, {0.0, 0.0, 0.62}});
  } else {
    figure.trunk({{0.0, 0.0, 0.45}, {0.09, 0.065, 0.5}, {0.085, 0.06, 0.58}, {0.0, 0.0, 0.6}});
  }
  sketch.use(outfit.top);
  figure.trunk({{0.0, 0.0, 0.56},
                {0.086, 0.062, 0.57},
                {0.078, 0.056, 0.64},
                {0.108, 0.066, 0.76},
                {0.1, 0.056, 0.81},
                {0.0, 0.0, 0.845}});
  draw_arm(figure, stance.right, 1.0, outfit);
  draw_arm(figure, stance.left, -1.0, outfit);
  draw_head(figure, outfit);
}

}  // namespace gnomon
