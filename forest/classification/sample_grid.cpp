// Neighbouring pixels a few millimetres apart probe nearly the same depths, and results are
// smoothed over a patch anyway, so only samples are classified. Departure from Shotton et al. 2011,
// who classify every pixel.
#include "forest/classification/sample_grid_internal.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ossa::forest {
namespace {

// Constants: sizes of tiles, for speed.

// Tiles of 16 × 8 cells: the samples that are walked together.
constexpr int kTileColumns = 16;
constexpr int kTileRows = 8;

std::vector<Between> PlacesOnGrid(int pixels, double spacing) {
  std::vector<Between> places(static_cast<size_t>(pixels));
  for (int i = 0; i < pixels; ++i) {
    Between& place = places[static_cast<size_t>(i)];
    const double at = (i + 0.5) / spacing;
    place.cell = static_cast<int32_t>(at);
    const double low = std::floor(at - 0.5);
    place.low = static_cast<int32_t>(low);
    place.eighths = static_cast<int32_t>(std::lround(8 * (at - 0.5 - low)));
    place.is_centre = i == static_cast<int>((place.cell + 0.5) * spacing);
  }
  return places;
}

// The pixels of each cell along one axis.
struct Cell {
  int begin = 0, end = 0;
  int centre = -1;  // nearest to the cell's centre; -1: outside the box
};

std::vector<Cell> FindCells(const std::vector<Between>& places) {
  std::vector<Cell> cells;
  for (size_t i = 0; i < places.size(); ++i) {
    const int pixel = static_cast<int>(i);
    if (cells.size() <= static_cast<size_t>(places[i].cell)) cells.push_back({pixel, pixel, -1});
    cells.back().end = pixel + 1;
    if (places[i].is_centre) cells.back().centre = pixel;
  }
  return cells;
}

// Whether a pixel belongs to the object: others have the value of the border.
bool IsObject(const ObjectImage& image, int x, int y) {
  return image.depth_mm[image.At(x, y)] != image.depth_mm.front();
}

// The sample pixel of a cell: its centre, else the first pixel; or kNone.
int32_t ChoosePixel(const ObjectImage& image, const Cell& column, const Cell& row) {
  if (column.centre >= 0 && row.centre >= 0 && IsObject(image, column.centre, row.centre)) {
    return row.centre << 16 | column.centre;
  }
  for (int y = row.begin; y < row.end; ++y) {
    for (int x = column.begin; x < column.end; ++x) {
      if (IsObject(image, x, y)) return y << 16 | x;
    }
  }
  return SparsePixels::kNone;
}

// Chooses the sample of each cell, tile by tile.
void ChoosePerCell(const ObjectImage& image, SparsePixels* sparse) {
  ObjectImage& grid = sparse->grid;
  const std::vector<Cell> columns = FindCells(sparse->column);
  const std::vector<Cell> rows = FindCells(sparse->row);
  for (int y0 = 0; y0 < grid.height; y0 += kTileRows) {
    for (int x0 = 0; x0 < grid.width; x0 += kTileColumns) {
      for (int y = y0; y < std::min(grid.height, y0 + kTileRows); ++y) {
        int32_t* row = &sparse->sample[static_cast<size_t>(y) * static_cast<size_t>(grid.width)];
        for (int x = x0; x < std::min(grid.width, x0 + kTileColumns); ++x) {
          const int32_t p =
              ChoosePixel(image, columns[static_cast<size_t>(x)], rows[static_cast<size_t>(y)]);
          if (p == SparsePixels::kNone) continue;
          row[x] = static_cast<int32_t>(sparse->position.size());
          grid.depth_mm[grid.At(x, y)] = static_cast<uint16_t>(DepthAt(image, p));
          sparse->position.push_back(p);
        }
      }
    }
  }
  sparse->on_grid = sparse->position.size();
}

// The first of the four surrounding samples on the pixel's surface; or kNone.
int32_t SampleAround(const SparsePixels& sparse, const Between& x, const Between& y, int depth_mm) {
  const ObjectImage& grid = sparse.grid;
  for (int corner = 0; corner < 4; ++corner) {
    const int cell_x = x.low + corner % 2;
    const int cell_y = y.low + corner / 2;
    const int32_t sample = sparse.SampleAt(cell_x, cell_y);
    if (sample == SparsePixels::kNone) continue;
    if (SameSurface(grid.depth_mm[grid.At(cell_x, cell_y)], depth_mm)) return sample;
  }
  return SparsePixels::kNone;
}

// Assigns each pixel the sample of its cell, else another of the four around it, else makes it a
// sample itself.
void SpreadSamples(const ObjectImage& image, std::span<const int32_t> position,
                   SparsePixels* sparse) {
  const ObjectImage& grid = sparse->grid;
  sparse->from.resize(position.size());
  int32_t* from = sparse->from.data();
  std::vector<int32_t> cell_of;  // cell of each x
  for (const Between& column : sparse->column) cell_of.push_back(column.cell);
  ForRows(position, kPositionRow, [&](int y, size_t first, size_t last) {
    const Between& row = sparse->row[static_cast<size_t>(y)];
    const uint16_t* cell_mm = &grid.depth_mm[grid.At(0, row.cell)];
    const int32_t* cell_sample =
        &sparse->sample[static_cast<size_t>(row.cell) * static_cast<size_t>(grid.width)];
    const uint16_t* pixel_mm = &image.depth_mm[image.At(0, y)];
    for (size_t i = first; i < last; ++i) {
      const int x = position[i] & 0xffff;
      const int32_t cell = cell_of[static_cast<size_t>(x)];
      int32_t sample = cell_sample[cell];
      if (!SameSurface(cell_mm[cell], pixel_mm[x])) {
        sample = SampleAround(*sparse, sparse->column[static_cast<size_t>(x)], row, pixel_mm[x]);
      }
      if (sample == SparsePixels::kNone) {
        sample = static_cast<int32_t>(sparse->position.size());
        sparse->position.push_back(position[i]);
      }
      from[i] = sample;
    }
  });
}

}  // namespace

SparsePixels ChooseSparse(const ObjectImage& image, std::span<const int32_t> position,
                          double spacing) {
  SparsePixels sparse;
  sparse.column = PlacesOnGrid(image.width, spacing);
  sparse.row = PlacesOnGrid(image.height, spacing);
  ObjectImage& grid = sparse.grid;
  grid.width = sparse.column.empty() ? 0 : sparse.column.back().cell + 1;
  grid.height = sparse.row.empty() ? 0 : sparse.row.back().cell + 1;
  grid.depth_mm.assign(static_cast<size_t>(grid.stride()) * static_cast<size_t>(grid.height + 2),
                       0);
  sparse.sample.assign(static_cast<size_t>(grid.width) * static_cast<size_t>(grid.height),
                       SparsePixels::kNone);
  sparse.position.reserve(sparse.sample.size());
  ChoosePerCell(image, &sparse);
  SpreadSamples(image, position, &sparse);
  return sparse;
}

}  // namespace ossa::forest
