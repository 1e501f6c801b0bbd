// SPDX-License-Identifier: Apache-2.0
// Bytes or PSNR in place of a step: the encoder's rate control.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "slf/encoder.h"

namespace slf {

bool has_target(const EncoderSettings& settings);

/// @errors kInvalidArgument: two targets, one out of range, a PSNR without cameras, or a target for
///         textures, whose quality is a QP.
Result<Done, InputError> check_target(const EncoderSettings& settings, std::size_t cameras);

/// Warnings that no step meets a target.
std::string missed_bytes(std::size_t target, std::size_t nearest);
std::string missed_psnr(double target, double nearest);

/// Calls code(q), which fills encoded.stream, with steps that come nearer and nearer; the last call
/// is the one that stays. Where no step meets the target, the nearest stays and a warning says so.
/// A target in bytes is met by 99 to 100 % of it, one in PSNR by up to 0.05 dB more.
Result<Done, InputError> code_to_target(
    const EncoderSettings& settings, const Capture& capture, std::span<const int> cameras,
    const std::function<Result<Done, InputError>(double q)>& code, Encoded& encoded);

}  // namespace slf
