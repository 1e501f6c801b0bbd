#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Wrote laspy.las, with laspy 2.7: four points in thousandths from an offset, colours of 16 bits.

    write_las.py laspy.las
"""
import sys

import laspy
import numpy as np

header = laspy.LasHeader(point_format=7, version="1.4")
header.scales, header.offsets = np.full(3, 0.001), np.array([500000.0, 4000000.0, 100.0])
cloud = laspy.LasData(header)
steps = np.arange(4)
cloud.x, cloud.y, cloud.z = 500000 + 0.125 * steps, 4000000 - 0.25 * steps, 100 + 0.5 * steps
cloud.red, cloud.green, cloud.blue = (np.full(4, 257 * value, np.uint16) for value in (200, 120, 40))
cloud.write(sys.argv[1])
