# SPDX-License-Identifier: Apache-2.0
"""Length of integers in an adaptive binary arithmetic coder, for what does not pass `slf pack`: indices, bases, blocks of pictures.

A magnitude is unary up to 14 (a 1 for each that it is larger), each decision in the context (given, which decision), then
Exp-Golomb bits and the sign at one bit each. A context's estimate is Krichevsky and Trofimov's, (ones + 1/2) / (all + 1), whose
length depends on the counts alone, so that nothing has to be coded one by one. A real coder adds some bytes in all."""
import numpy as np
from scipy.special import betaln

UNARY = 14


def adaptive_bits(bits, contexts):
    """Length of binary decisions, each in the context of its number."""
    if not len(bits):
        return 0.0
    ones = np.bincount(contexts, bits)
    zeros = np.bincount(contexts) - ones
    return float(-(betaln(ones + 0.5, zeros + 0.5) - betaln(0.5, 0.5)).sum() / np.log(2))


def bits_of(values, contexts):
    """Length of whole numbers; `contexts`: a whole number from 0 for each."""
    magnitudes, contexts = np.abs(np.ravel(values)).astype(np.int64), np.ravel(contexts).astype(np.int64)
    total = float(np.count_nonzero(magnitudes))  # signs
    for decision in range(UNARY):
        total += adaptive_bits((magnitudes > decision).astype(float), contexts)
        contexts, magnitudes = contexts[magnitudes > decision], magnitudes[magnitudes > decision]
        if not len(magnitudes):
            return total
    return total + float((2 * np.floor(np.log2(magnitudes - UNARY + 1)) + 1).sum() if len(magnitudes) else 0)


def index_bits(indices, before, count):
    """Length of numbers below `count` that are often those of `before`: [N, B] earlier neighbours' numbers, the nearest first.

    A decision for each neighbour that differs from those before it (the same?), then the number itself, bit by bit in a tree."""
    left, total = np.ones(len(indices), bool), 0.0
    for b in range(before.shape[1]):
        fresh = left & ~(before[:, b:b + 1] == before[:, :b]).any(1) if b else left
        same = indices == before[:, b]
        agree = (before == before[:, b:b + 1]).sum(1)
        total += adaptive_bits(same[fresh].astype(float), (b * (before.shape[1] + 1) + agree)[fresh])
        left = left & ~same
    rest, depth = indices[left].astype(np.int64), max(int(count - 1).bit_length(), 1)
    for level in range(depth):
        node = (1 << level) - 1 + (rest >> (depth - level))
        total += adaptive_bits(((rest >> (depth - 1 - level)) & 1).astype(float), node)
    return total


def magnitude_class(values):
    """0, 1, 2 and more, more: 0 .. 4, of sums of neighbours' magnitudes."""
    return np.searchsorted([0.5, 1.5, 2.5, 5.5], np.abs(values), side="right")
