#include <embree3/rtcore.h>

#include <array>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "render/cpu/ball_traversal.h"

namespace atomesh {

namespace {

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using Spheres = std::unique_ptr<RTCSceneTy, ReleaseScene>;

void check(RTCDevice device, std::string_view doing) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  throw UnavailableError(
      "atom balls: Embree failed " + std::string(doing) +
      (error == RTC_ERROR_OUT_OF_MEMORY ? ": out of memory" : " (error " + std::to_string(error) + ")"));
}

Device make_device() {
  Device device(rtcNewDevice(("threads=" + std::to_string(threads())).c_str()));
  if (!device) check(nullptr, "to start");
  return device;
}

Spheres make_spheres(RTCDevice device, const std::vector<Ball>& balls, float enlarged_by) {
  Spheres hierarchy(rtcNewScene(device));
  rtcSetSceneFlags(hierarchy.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  rtcSetSceneBuildQuality(hierarchy.get(), RTC_BUILD_QUALITY_LOW);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* spheres = static_cast<Vec4f*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(Vec4f), balls.size()));
  if (spheres != nullptr) {
    parallel_for(balls.size(), 65536, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) spheres[i] = Vec4f(balls[i].center, balls[i].radius + enlarged_by);
    });
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(hierarchy.get(), geometry);
  }
  rtcReleaseGeometry(geometry);
  if (spheres != nullptr) rtcCommitScene(hierarchy.get());
  check(device, "to build the hierarchy of " + std::to_string(balls.size()) + " balls");
  return hierarchy;
}

constexpr int side = 4;
constexpr unsigned lanes = side * side;
static_assert(BallTile::side % side == 0);

// A square of pixels traced together; the context of its query, by which the filter finds it.
struct Packet : RTCIntersectContext {
  const std::vector<Ball>* balls = nullptr;
  double slack = 0.0;  // Å, see Hierarchy::slack_
  std::array<const optics::BallRay*, lanes> rays{};
  std::array<BallHits*, lanes> hits{};
  std::array<double, lanes> start{};  // length from the ray's origin to where Embree's ray begins
};

// Embree proposes a sphere: what is true of it goes to the ray's hits. The ray is never shortened to the proposed hit
// (a rejected hit leaves it as it was), only to where nothing can be seen any more.
void take_proposal(const RTCFilterFunctionNArguments* args) {
  auto& packet = *static_cast<Packet*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const unsigned lane = RTCRayN_id(args->ray, args->N, i);
    const Index index = RTCHitN_primID(args->hit, args->N, i);
    const Ball& ball = (*packet.balls)[index];
    BallHits& hits = *packet.hits[lane];
    const double length = optics::length_to_ball(*packet.rays[lane], ball);
    if (std::isfinite(length)) hits.add(length, index, static_cast<double>(ball.color.a));
    if (std::isinf(hits.reach())) {
      args->valid[i] = 0;
    } else {
      RTCRayN_tfar(args->ray, args->N, i) = static_cast<float>(hits.reach() - packet.start[lane] + packet.slack);
    }
  }
}

class Hierarchy final : public BallTraversal {
 public:
  explicit Hierarchy(const Scene& scene) : scene_(scene) {
    Bounds bounds;
    double largest = 0.0;
    for (const Ball& ball : scene.balls) {
      bounds.add(Vec3(ball.center));
      largest = std::max(largest, static_cast<double>(ball.radius));
    }
    middle_ = bounds.center();
    radius_ = 0.5 * bounds.diagonal() + largest;
    slack_ = 8e-6 * (radius_ + glm::length(middle_));
    device_ = make_device();
    spheres_ = make_spheres(device_.get(), scene.balls, static_cast<float>(slack_));
  }

  void trace(BallTile& tile) const override {
    for (int top = 0; top < tile.grid.rows(); top += side) {
      for (int left = 0; left < tile.grid.columns(); left += side) trace_packet(tile, left, top);
    }
  }

 private:
  void trace_packet(BallTile& tile, int left, int top) const {
    Packet packet;
    rtcInitIntersectContext(&packet);
    packet.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    packet.filter = take_proposal;
    packet.balls = &scene_.balls;
    packet.slack = slack_;
    alignas(64) RTCRayHit16 query{};
    alignas(64) std::array<int, lanes> valid{};
    for (unsigned lane = 0; lane < lanes; ++lane) {
      const int i = left + static_cast<int>(lane % side);
      const int j = top + static_cast<int>(lane / side);
      if (i >= tile.grid.columns() || j >= tile.grid.rows()) continue;
      const std::size_t pixel = BallTile::place(i, j);
      const optics::BallRay& ray = tile.rays[pixel];
      // Where the ray comes near the balls. Starting there instead of at the eye keeps the coordinates small, which
      // Embree's float needs.
      const double start = std::max(0.0, glm::dot(middle_ - ray.origin, ray.direction) - radius_);
      const Vec3f origin(ray.origin + start * ray.direction);
      const Vec3f direction(ray.direction);
      valid[lane] = -1;
      packet.rays[lane] = &ray;
      packet.hits[lane] = &tile.hits[pixel];
      packet.start[lane] = start;
      query.ray.org_x[lane] = origin.x;
      query.ray.org_y[lane] = origin.y;
      query.ray.org_z[lane] = origin.z;
      query.ray.dir_x[lane] = direction.x;
      query.ray.dir_y[lane] = direction.y;
      query.ray.dir_z[lane] = direction.z;
      query.ray.tnear[lane] = 0.0F;
      query.ray.tfar[lane] = std::numeric_limits<float>::infinity();
      query.ray.mask[lane] = ~0U;
      query.ray.id[lane] = lane;
      query.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid.data(), spheres_.get(), &packet, &query);
  }

  const Scene& scene_;
  Vec3 middle_;    // scene coordinates
  double radius_;  // Å, of the balls' bounding sphere about the middle
  // Å. A generous bound of what float makes of lengths and distances: coordinates are below twice the sum, and each
  // takes some ten roundings of 6e-8. Spheres are larger by this, and rays longer.
  double slack_;
  Device device_;
  Spheres spheres_;
};

}  // namespace

std::unique_ptr<BallTraversal> build_ball_hierarchy(const Scene& scene) {
  return std::make_unique<Hierarchy>(scene);
}

}  // namespace atomesh
