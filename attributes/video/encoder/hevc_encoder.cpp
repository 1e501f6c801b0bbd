// SPDX-License-Identifier: Apache-2.0
#include "attributes/video/encoder/hevc_encoder.h"

#if SLF_WITH_X265
#include <x265.h>

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <span>
#endif

namespace slf {

#if SLF_WITH_X265
namespace {

constexpr std::array<const char*, 9> kPresets = {
    "ultrafast", "superfast", "veryfast", "faster", "fast", "medium", "slow", "slower", "veryslow"};

InputError invalid(const std::string& what) {
  return {Errc::kInvalidArgument, "HEVC encoding: " + what};
}

/// Opening and closing write to tables of x265 that all encoders share.
std::mutex& shared_tables() {
  static std::mutex mutex;
  return mutex;
}

struct FreeParam {
  const x265_api* api;
  void operator()(x265_param* param) const { api->param_free(param); }
};
using Param = std::unique_ptr<x265_param, FreeParam>;

struct CloseEncoder {
  const x265_api* api;
  void operator()(x265_encoder* encoder) const {
    const std::lock_guard lock(shared_tables());
    api->encoder_close(encoder);
  }
};
using Encoder = std::unique_ptr<x265_encoder, CloseEncoder>;

Result<Done, InputError> check_settings(const HevcSettings& settings) {
  if (settings.qp < 0 || settings.qp > 51) return invalid("qp: 0 to 51");
  if (std::find(kPresets.begin(), kPresets.end(), settings.preset) == kPresets.end())
    return invalid("no preset is named " + settings.preset);
  return Done{};
}

/// Nothing here may depend on the machine: no thread pool, no wavefronts, one frame at a time.
void set_single_thread(x265_param& p) {
  p.frameNumThreads = 1;
  p.bEnableWavefront = 0;
  p.bDistributeModeAnalysis = 0;
  p.bDistributeMotionEstimation = 0;
  p.lookaheadThreads = 0;
  p.lookaheadSlices = 0;
}

void set_structure(x265_param& p, HevcMode mode) {
  p.bframes = 0;
  p.bFrameAdaptive = 0;
  p.bOpenGOP = 0;
  p.scenecutThreshold = 0;
  p.bHistBasedSceneCut = 0;
  p.lookaheadDepth = 0;
  p.keyframeMax = mode == HevcMode::kIntra ? 1 : -1;  // -1: never again
}

void set_rate(x265_param& p, const HevcSettings& settings) {
  p.rc.rateControlMode = X265_RC_CQP;
  p.rc.qp = settings.qp;
  p.rc.ipFactor = settings.mode == HevcMode::kIntra ? 1.0 : 1.41421356;  // 6 log2: 0 or 3 steps
  p.rc.aqMode = X265_AQ_NONE;
  p.rc.cuTree = 0;
  p.bLossless = settings.lossless;
}

Param parameters(const x265_api* api, const HevcSettings& settings, const VideoFormat& first) {
  Param param(api->param_alloc(), FreeParam{api});
  if (!param || api->param_default_preset(param.get(), settings.preset.c_str(), "psnr") != 0)
    return Param(nullptr, FreeParam{api});
  x265_param& p = *param;
  p.logLevel = X265_LOG_NONE;
  p.internalBitDepth = first.bits;
  p.sourceBitDepth = first.bits;
  p.internalCsp = static_cast<int>(first.chroma);
  p.sourceWidth = first.width;
  p.sourceHeight = first.height;
  p.fpsNum = 25;  // has no meaning, but has to be there
  p.fpsDenom = 1;
  // x265 refuses pictures smaller than a coding tree unit.
  const int smaller = std::min(first.width, first.height);
  if (smaller < 64) p.maxCUSize = std::min(p.maxCUSize, smaller < 32 ? 16u : 32u);
  p.maxTUSize = std::min(p.maxTUSize, p.maxCUSize);
  p.bAnnexB = 1;
  p.bRepeatHeaders = 0;
  p.bEmitInfoSEI = 0;
  p.decodedPictureHashSEI = 0;
  p.bEnableAccessUnitDelimiters = 0;
  // Presets without SAO, above 8 bits, give streams that libde265 1.0.11 decodes wrongly.
  p.bEnableSAO = 1;
  set_single_thread(p);
  set_structure(p, settings.mode);
  set_rate(p, settings);
  return param;
}

/// Samples in memory as x265 reads them: one byte each, or two.
class SourcePicture {
 public:
  SourcePicture(const x265_api* api, x265_param* param, const Picture& picture) {
    api->picture_init(param, &picture_);
    picture_.bitDepth = picture.bits;
    picture_.colorSpace = static_cast<int>(picture.chroma);
    for (std::size_t i = 0; i < picture.planes.size(); ++i) {
      const auto& samples = picture.planes[i];
      const int width = plane_size(picture.width, picture.chroma, static_cast<int>(i));
      picture_.stride[i] = picture.bits > 8 ? 2 * width : width;
      if (picture.bits > 8) {
        picture_.planes[i] = const_cast<std::uint16_t*>(samples.data());  // x265 reads only
        continue;
      }
      bytes_[i].resize(samples.size());
      std::transform(samples.begin(), samples.end(), bytes_[i].begin(),
                     [](std::uint16_t sample) { return static_cast<std::uint8_t>(sample); });
      picture_.planes[i] = bytes_[i].data();
    }
  }
  x265_picture* get() { return &picture_; }

 private:
  x265_picture picture_{};
  std::array<std::vector<std::uint8_t>, 3> bytes_;
};

/// x265 repeats the parameter sets before every intra picture; the stream needs them once.
bool is_parameter_set(const x265_nal& unit) {
  return unit.type == NAL_UNIT_VPS || unit.type == NAL_UNIT_SPS || unit.type == NAL_UNIT_PPS;
}

void append(std::vector<std::uint8_t>& stream, std::span<const x265_nal> units, bool headers) {
  for (const x265_nal& unit : units)
    if (is_parameter_set(unit) == headers)
      stream.insert(stream.end(), unit.payload, unit.payload + unit.sizeBytes);
}

}  // namespace

Result<std::vector<std::uint8_t>, InputError> encode_hevc(
    std::size_t pictures, const std::function<Picture(std::size_t)>& source,
    const HevcSettings& settings) {
  SLF_CHECK(check_settings(settings));
  if (pictures == 0) return invalid("no pictures");
  Picture picture = source(0);
  const VideoFormat first{picture.width, picture.height, picture.bits, picture.chroma, pictures};
  SLF_CHECK(check_picture(picture, first));
  const InputError failed{Errc::kLimitExceeded, "HEVC encoding: x265 failed"};
  const x265_api* api = x265_api_get(first.bits);
  if (api == nullptr)
    return InputError{Errc::kUnsupported, "HEVC encoding: this x265 has no " +
                                              std::to_string(first.bits) + " bit samples"};
  const Param param = parameters(api, settings, first);
  if (!param) return failed;
  std::unique_lock lock(shared_tables());
  const Encoder encoder(api->encoder_open(param.get()), CloseEncoder{api});
  lock.unlock();
  if (!encoder) return failed;

  std::vector<std::uint8_t> stream;
  x265_nal* units = nullptr;
  std::uint32_t count = 0;
  if (api->encoder_headers(encoder.get(), &units, &count) < 0) return failed;
  append(stream, {units, count}, true);
  for (std::size_t i = 0; i < pictures; ++i) {
    if (i > 0) picture = source(i);
    SLF_CHECK(check_picture(picture, first));
    SourcePicture in(api, param.get(), picture);
    if (api->encoder_encode(encoder.get(), &units, &count, in.get(), nullptr) < 0) return failed;
    append(stream, {units, count}, false);
  }
  for (int coded = 1; coded > 0; append(stream, {units, count}, false)) {
    coded = api->encoder_encode(encoder.get(), &units, &count, nullptr, nullptr);
    if (coded < 0) return failed;
  }
  return stream;
}
#else
Result<std::vector<std::uint8_t>, InputError> encode_hevc(
    std::size_t, const std::function<Picture(std::size_t)>&, const HevcSettings&) {
  return InputError{Errc::kUnsupported, "HEVC encoding: x265 is not part of this build (SLF_X265)"};
}
#endif

}  // namespace slf
