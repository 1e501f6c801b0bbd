#include "lightfield/fit_pictures.h"

#include "lightfield/picture_system.h"
#include "lightfield/picture_views.h"
#include "lightfield/surfel_cloud.h"

namespace slf {
namespace {

PictureError sum(const std::vector<PictureError>& errors) {
  PictureError sum;
  for (const PictureError& e : errors) sum += e;
  return sum;
}

}  // namespace

Result<PictureFit, InputError> fit_to_pictures(const PictureFitInput& input,
                                                     const FitSettings& settings,
                                                     std::vector<float>& coefficients,
                                                     const Progress& progress) {
  const SurfelCloud cloud =
      surfel_cloud(input.grid, input.positions, input.normals, 0, settings.threads);
  SLF_TRY(PictureViews pictures, picture_views(input.capture, input.cameras, cloud, input.transfer,
                                               settings.threads, progress));
  std::vector<Vec3> eyes;
  for (const int c : input.cameras)
    eyes.push_back(input.capture.cameras[static_cast<std::size_t>(c)].centre());
  PictureSystem system(input.grid, input.positions, settings, input.gamma_range, pictures,
                       std::move(eyes));
  auto colours = system.colours(coefficients);
  PictureSystem::Vector z(colours.size());
  PictureFit report;
  report.psnr_before = sum(system.errors(colours)).psnr();
  const PictureFitSettings& s = settings.pictures;
  for (int round = 0; round < s.rounds; ++round) {
    if (progress) progress("fit pictures", double(round) / s.rounds);
    system.set_trust(colours, s.outlier);
    system.improve([](std::size_t) { return true; }, s.steps, colours, z);
  }
  report.psnr_after = sum(system.errors(colours)).psnr();
  system.add(z, coefficients);
  if (progress) progress("fit pictures", 1);
  return report;
}

}  // namespace slf
