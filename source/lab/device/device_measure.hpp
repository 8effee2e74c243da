// Measuring methods on a device: the same loop as on the CPU, with the times of the GPU and of the whole
// frame.
#pragma once

#include "lab/device/workbench.hpp"
#include "lab/measure.hpp"

namespace sightline::lab {

struct DeviceMeasureOptions {
  MeasureOptions measure;
  double moving = 0;  ///< share of the objects that move before every frame
};

/// For each view all methods by turns, in an order that rotates; lost and excess objects against the device's
/// own item buffer. Throws Error as compare() does.
Comparison compare_on_device(Workbench& bench, const CameraPath& path, const DeviceMeasureOptions& options,
                             const Progress& progress = {});

}  // namespace sightline::lab
