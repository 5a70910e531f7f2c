#include "scenes/gltf_rows.hpp"

#include <cstring>

namespace torsion::engine {

int append_rows(tinygltf::Model& model, int buffer, std::span<const std::byte> rows,
                const RowKind& kind) {
  std::vector<unsigned char>& data = model.buffers[static_cast<std::size_t>(buffer)].data;
  data.resize((data.size() + 3) / 4 * 4);
  tinygltf::BufferView view;
  view.buffer = buffer;
  view.byteOffset = data.size();
  view.byteLength = rows.size();
  view.target = kind.target;
  data.resize(data.size() + rows.size());
  std::memcpy(data.data() + view.byteOffset, rows.data(), rows.size());
  model.bufferViews.push_back(view);
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
  accessor.componentType = kind.component;
  accessor.type = kind.type;
  accessor.count = kind.count;
  model.accessors.push_back(accessor);
  return static_cast<int>(model.accessors.size()) - 1;
}

}  // namespace torsion::engine
