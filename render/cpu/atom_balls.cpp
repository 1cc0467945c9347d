#include "render/cpu/atom_balls.h"

#include <embree3/rtcore.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "render/cpu/ball_hits.h"
#include "render/shared/ball_ray.h"
#include "render/shared/lights.h"
#include "render/shared/materials.h"

namespace atomesh {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using Hierarchy = std::unique_ptr<RTCSceneTy, ReleaseScene>;

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

Hierarchy make_hierarchy(RTCDevice device, const std::vector<Ball>& balls, float enlarged_by) {
  Hierarchy hierarchy(rtcNewScene(device));
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

// A square of pixels traced together; the context of its query, by which the filter finds it.
struct Packet : RTCIntersectContext {
  const std::vector<Ball>* balls = nullptr;
  double slack = 0.0;  // Å, see draw_atom_balls
  std::array<optics::BallRay, lanes> rays{};
  std::vector<BallHits> hits{lanes, BallHits(faintest)};
  std::array<double, lanes> start{};  // length from the ray's origin to where Embree's ray begins
};

// Embree proposes a sphere: what is true of it goes to the packet's hits. The ray is never shortened to the proposed
// hit (a rejected hit leaves it as it was), only to where nothing can be seen any more.
void take_proposal(const RTCFilterFunctionNArguments* args) {
  auto& packet = *static_cast<Packet*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const unsigned lane = RTCRayN_id(args->ray, args->N, i);
    const Index index = RTCHitN_primID(args->hit, args->N, i);
    const Ball& ball = (*packet.balls)[index];
    BallHits& hits = packet.hits[lane];
    const double length = optics::length_to_ball(packet.rays[lane], ball);
    if (std::isfinite(length)) hits.add({length, index, static_cast<double>(ball.color.a)});
    if (std::isinf(hits.reach())) {
      args->valid[i] = 0;
    } else {
      RTCRayN_tfar(args->ray, args->N, i) = static_cast<float>(hits.reach() - packet.start[lane] + packet.slack);
    }
  }
}

// What all packets share.
struct View {
  const Scene& scene;
  const Camera& camera;
  std::vector<optics::LightRay> lights;
  double radius;  // Å, of the balls' bounding sphere about the middle
  Vec3 middle;    // scene coordinates

  View(const Scene& s, const Camera& c, const Parameters& parameters)
      : scene(s), camera(c), lights(optics::scene_lights(parameters, s, c)) {
    Bounds bounds;
    double largest = 0.0;
    for (const Ball& ball : s.balls) {
      bounds.add(Vec3(ball.center));
      largest = std::max(largest, static_cast<double>(ball.radius));
    }
    middle = bounds.center();
    radius = 0.5 * bounds.diagonal() + largest;
  }

  // Where a ray comes near the balls. Starting there instead of at the eye keeps the coordinates small, which Embree's
  // float needs.
  double start_of(const optics::BallRay& ray) const {
    return std::max(0.0, glm::dot(middle - ray.origin, ray.direction) - radius);
  }
  // A generous bound of what float makes of lengths and distances on a ray that starts at start_of(): coordinates are
  // below twice `size` and each takes some ten roundings of 6e-8.
  double slack() const {
    const double size = radius + glm::length(middle);
    return 8e-6 * size;
  }

  // Composed front to back, premultiplied.
  Vec4f shade(const optics::BallRay& ray, const std::vector<BallHits::Hit>& hits) const {
    Vec3f color(0.0F);
    float left = 1.0F;
    for (const BallHits::Hit& hit : hits) {
      const Ball& ball = scene.balls[hit.ball];
      const Vec3 point = ray.origin + hit.length * ray.direction;
      const Vec3f normal(glm::normalize(point - Vec3(ball.center)));
      const Vec3f lit = optics::phong(optics::ball_material(Vec3f(ball.color)), Vec3f(point), normal,
                                      Vec3f(-ray.direction), lights.data(), static_cast<int>(lights.size()));
      color += left * ball.color.a * lit;
      left *= 1.0F - ball.color.a;
    }
    return {color, 1.0F - left};
  }
};

void trace(RTCScene hierarchy, const View& view, Packet& packet, int left, int top) {
  alignas(64) RTCRayHit16 query{};
  alignas(64) std::array<int, lanes> valid{};
  for (unsigned lane = 0; lane < lanes; ++lane) {
    const int column = left + static_cast<int>(lane % side);
    const int row = top + static_cast<int>(lane / side);
    packet.hits[lane].clear();
    if (column >= view.camera.width || row >= view.camera.height) continue;
    valid[lane] = -1;
    const optics::BallRay ray = optics::ball_ray(view.scene, view.camera, column, row);
    const double start = view.start_of(ray);
    const Vec3f origin(ray.origin + start * ray.direction);
    const Vec3f direction(ray.direction);
    packet.rays[lane] = ray;
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
  rtcIntersect16(valid.data(), hierarchy, &packet, &query);
}

}  // namespace

Image draw_atom_balls(const Scene& scene, const Camera& camera, const Parameters& parameters, RenderStats& stats,
                      const Channels& channels, Progress& progress) {
  progress.stage("atom balls");
  Image image(camera.width, camera.height);
  if (channels.depth != nullptr) channels.depth->assign(image.pixels.size(), std::numeric_limits<float>::infinity());
  if (channels.id != nullptr) channels.id->assign(image.pixels.size(), no_index);
  stats = {};
  if (scene.balls.empty()) return image;

  const Clock::time_point building = Clock::now();
  const View view(scene, camera, parameters);
  const Device device = make_device();
  const Hierarchy hierarchy = make_hierarchy(device.get(), scene.balls, static_cast<float>(view.slack()));
  stats.setup_ms = ms_since(building);

  const Clock::time_point drawing = Clock::now();
  std::atomic<std::uint64_t> steps{0};
  const auto rows = static_cast<std::size_t>((camera.height + side - 1) / side);
  parallel_for(rows, 1, [&](std::size_t begin, std::size_t end) {
    progress.check();
    Packet packet;
    rtcInitIntersectContext(&packet);
    packet.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    packet.filter = take_proposal;
    packet.balls = &scene.balls;
    packet.slack = view.slack();
    std::uint64_t composed = 0;
    for (std::size_t r = begin; r < end; ++r) {
      const int top = static_cast<int>(r) * side;
      for (int left = 0; left < camera.width; left += side) {
        trace(hierarchy.get(), view, packet, left, top);
        for (unsigned lane = 0; lane < lanes; ++lane) {
          const auto& hits = packet.hits[lane].hits();
          if (hits.empty()) continue;
          const int column = left + static_cast<int>(lane % side);
          const int row = top + static_cast<int>(lane / side);
          image.at(column, row) = view.shade(packet.rays[lane], hits);
          composed += hits.size();
          const auto pixel =
              static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(column);
          if (channels.depth != nullptr) {
            const double along = glm::dot(packet.rays[lane].direction, camera.forward);
            (*channels.depth)[pixel] = static_cast<float>(hits.front().length * along);
          }
          if (channels.id != nullptr) (*channels.id)[pixel] = scene.balls[hits.front().ball].atom;
        }
      }
    }
    steps += composed;
  });
  stats.render_ms = ms_since(drawing);
  stats.steps = steps;
  progress.update(1.0);
  return image;
}

}  // namespace atomesh
