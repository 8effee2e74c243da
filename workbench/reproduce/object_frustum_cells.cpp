#include "workbench/reproduce/object_frustum_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "workbench/report/top_view.hpp"

namespace sightline::reproduce {

namespace {

// A drawing's units are quarters of a pixel, as report::path_of wants whole ones.
constexpr double kUnits = 4;
constexpr std::size_t kMostDots = 40'000;

struct Look {
  const char *fill, *edge;
};

Look look_of(DrawnCell::Kind kind) {
  switch (kind) {
    case DrawnCell::Kind::inside:
      return {"#2084d0", "#1a69a6"};
    case DrawnCell::Kind::crossing:
      return {"#e29e26", "#a8741a"};
    case DrawnCell::Kind::lost:
      return {"#de265c", "#a51c45"};
    case DrawnCell::Kind::outside:
      break;
  }
  return {"#949ca8", "#949ca8"};
}

// From metres on x–z to the drawing.
class Plan {
public:
  Plan(const std::vector<DrawnCell>& cells, const Vec3& eye, double width) {
    for (const DrawnCell& cell : cells) {
      min_x_ = std::min(min_x_, double{cell.ground.min.x}),
      max_x_ = std::max(max_x_, double{cell.ground.max.x});
      min_z_ = std::min(min_z_, double{cell.ground.min.z}),
      max_z_ = std::max(max_z_, double{cell.ground.max.z});
    }
    max_z_ = std::max(max_z_, double{eye.z});
    const double margin = 0.02 * (max_x_ - min_x_);
    min_x_ -= margin, min_z_ -= margin, max_x_ += margin, max_z_ += margin;
    scale_ = kUnits * width / (max_x_ - min_x_);
  }
  [[nodiscard]] double x(double metres) const { return (metres - min_x_) * scale_; }
  [[nodiscard]] double z(double metres) const { return (metres - min_z_) * scale_; }
  [[nodiscard]] double across() const { return x(max_x_); }
  [[nodiscard]] double down() const { return z(max_z_); }

private:
  double min_x_ = 1e30, max_x_ = -1e30, min_z_ = 1e30, max_z_ = -1e30, scale_ = 1;
};

std::string dots(const Plan& plan, const std::vector<Box>& boxes, const char* colour) {
  if (boxes.empty()) return "";
  std::vector<report::FlatBox> flat;
  for (const Box& box : boxes) {
    const double x = plan.x(0.5 * (box.min.x + box.max.x)), z = plan.z(0.5 * (box.min.z + box.max.z));
    const auto at = [](double units) { return static_cast<std::int32_t>(std::lround(units)); };
    flat.push_back({at(x) - 3, at(z) - 3, at(x) + 3, at(z) + 3});
  }
  return fmt::format("<path fill=\"{}\" fill-opacity=\".6\" d=\"{}\"/>\n", colour,
                     report::path_of(std::move(flat), kMostDots));
}

std::string cell_svg(const Plan& plan, const DrawnCell& cell) {
  const double x0 = plan.x(cell.ground.min.x), x1 = plan.x(cell.ground.max.x), z0 = plan.z(cell.ground.min.z),
               z1 = plan.z(cell.ground.max.z);
  const Look look = look_of(cell.kind);
  const bool listed = cell.kind != DrawnCell::Kind::outside;
  std::string svg = fmt::format(
      "<rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" fill=\"{}\" fill-opacity=\"{}\" "
      "stroke=\"{}\" stroke-width=\"3\"/>",
      x0, z0, x1 - x0, z1 - z0, look.fill, listed ? ".22" : ".05", look.edge);
  if (cell.kind == DrawnCell::Kind::crossing) {
    svg += fmt::format(
        "<path d=\"M{0:.0f} {1:.0f}L{2:.0f} {3:.0f}M{2:.0f} {1:.0f}L{0:.0f} {3:.0f}\" stroke=\"{4}\" "
        "stroke-width=\"3\" stroke-opacity=\".55\"/>",
        x0, z0, x1, z1, look.edge);
  }
  return svg + fmt::format(
                   "<text x=\"{:.0f}\" y=\"{:.0f}\" font-size=\"{}\" font-weight=\"600\" fill=\"#1e2228\" "
                   "stroke=\"#fff\" stroke-width=\"10\" paint-order=\"stroke\">{}</text>\n",
                   x0 + 16, z0 + 60, 13 * kUnits, cell.number);
}

// The two angle limits and the distance limit of a camera that looks along -z.
std::string limits_svg(const Plan& plan, const Camera& camera, float aspect) {
  const double tangent = std::tan(0.5 * camera.vertical_fov) * aspect, far = camera.far_plane;
  const double x = plan.x(camera.eye.x), z = plan.z(camera.eye.z),
               left = plan.x(camera.eye.x - far * tangent), right = plan.x(camera.eye.x + far * tangent),
               end = plan.z(camera.eye.z - far);
  return fmt::format(
      "<path d=\"M{0:.0f} {1:.0f}L{2:.0f} {4:.0f}L{3:.0f} {4:.0f}Z\" fill=\"none\" stroke=\"#1e2228\" "
      "stroke-width=\"8\"/><circle cx=\"{0:.0f}\" cy=\"{1:.0f}\" r=\"24\" fill=\"#1e2228\" stroke=\"#fff\" "
      "stroke-width=\"8\"/>\n",
      x, z, left, right, end);
}

}  // namespace

std::string draw_cells(const std::vector<DrawnCell>& cells, const Camera& camera, float aspect,
                       const std::vector<Box>& kept, const std::vector<Box>& dropped, std::uint32_t width) {
  const Plan plan(cells, camera.eye, width);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{2:.0f}\" "
      "height=\"{3:.0f}\" style=\"max-width:100%;height:auto\" font-family=\"sans-serif\"><rect "
      "width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      plan.across(), plan.down(), plan.across() / kUnits, plan.down() / kUnits);
  svg += dots(plan, dropped, "#c3c8cf") + dots(plan, kept, "#2a9d6e");
  for (const DrawnCell& cell : cells) svg += cell_svg(plan, cell);
  return svg + limits_svg(plan, camera, aspect) + "</svg>\n";
}

std::string cell_number(const partition::ObjectGrid& grid, std::uint32_t row, std::uint32_t column) {
  return fmt::format("{}.{}", grid.rows() - row, column + 1);
}

}  // namespace sightline::reproduce
