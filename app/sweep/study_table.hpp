#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "ecs/result.hpp"

namespace torsion::engine {

/// Writes the table of a study: as CSV, or as HDF5 with the table "runs" where the path ends in .h5
/// or .hdf5. There a column is of numbers if every row has one in it, else of texts.
/// @param header  names with commas between
/// @param lines   by run, each with as many fields
Result<Done> write_study_table(const std::filesystem::path& path, const std::string& header,
                               const std::map<std::uint64_t, std::string>& lines);

}  // namespace torsion::engine
