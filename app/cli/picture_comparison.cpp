#include "app/cli/picture_comparison.h"

namespace atomesh::cli {

PictureComparison compare_pictures(const std::string& picture, const std::string& reference, double tolerance,
                                   const std::string& difference_path, bool always, Session& session) {
  const Image a = read_png(picture);
  const Image b = read_png(reference);
  PictureComparison result;
  if (a.width != b.width || a.height != b.height) {
    session.print("{} is {}x{}, {} is {}x{}: different", picture, a.width, a.height, reference, b.width, b.height);
    result.json = Json::object({{"max", nullptr}, {"rmse", nullptr}, {"psnr", nullptr}, {"pixels_over", nullptr}});
    return result;
  }
  const ImageDifference difference = compare_images(a, b, tolerance);
  result.passed = difference.max <= tolerance;
  result.json = Json::object({{"max", difference.max},
                              {"rmse", difference.rmse},
                              {"psnr", difference.psnr},
                              {"pixels_over", difference.pixels_over},
                              {"tolerance", tolerance}});
  session.print("max {:.6f} ({:.2f}/255), rmse {:.6f}, psnr {:.2f} dB, {} pixels over {:.6f}: {}", difference.max,
                255.0 * difference.max, difference.rmse, difference.psnr, difference.pixels_over, tolerance,
                result.passed ? "same" : "different");
  if (!difference_path.empty() && (always || !result.passed)) {
    write_png(difference_path, difference_picture(a, b));
    session.print("{}: the difference, eight times as strong", difference_path);
    result.json.set("difference", difference_path);
  }
  return result;
}

}  // namespace atomesh::cli
