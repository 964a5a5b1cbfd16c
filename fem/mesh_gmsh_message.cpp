#include "fem/mesh_gmsh_message.hpp"

#include <cstring>
#include <stdexcept>

namespace voussoir::fem {

namespace {

void require(bool holds) {
  if (!holds) throw std::runtime_error("what Gmsh makes of it does not fit together");
}

class Writer {
 public:
  void add(std::size_t n) { add_bytes(&n, sizeof n); }
  void add(const std::string& text) {
    add(text.size());
    add_bytes(text.data(), text.size());
  }
  /// A list of numbers.
  template <class T>
  void add_numbers(const std::vector<T>& list) {
    add(list.size());
    add_bytes(list.data(), sizeof(T) * list.size());
  }
  void add(const std::vector<std::string>& list) {
    add(list.size());
    for (const std::string& text : list) add(text);
  }
  [[nodiscard]] std::string bytes() && { return std::move(bytes_); }

 private:
  void add_bytes(const void* from, std::size_t n) { bytes_.append(static_cast<const char*>(from), n); }

  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}

  std::size_t number() {
    std::size_t n = 0;
    take(&n, sizeof n);
    return n;
  }
  std::string text() {
    std::string text(number_of(1), '\0');
    take(text.data(), text.size());
    return text;
  }
  template <class T>
  std::vector<T> numbers() {
    std::vector<T> list(number_of(sizeof(T)));
    take(list.data(), sizeof(T) * list.size());
    return list;
  }
  std::vector<std::string> texts() {
    std::vector<std::string> list(number_of(1));
    for (std::string& entry : list) entry = text();
    return list;
  }
  [[nodiscard]] bool is_at_end() const { return at_ == bytes_.size(); }

 private:
  /// The number of entries of a list, which must be there.
  std::size_t number_of(std::size_t bytes_each) {
    const std::size_t n = number();
    require(n <= (bytes_.size() - at_) / bytes_each);
    return n;
  }
  void take(void* to, std::size_t n) {
    require(n <= bytes_.size() - at_);
    if (n > 0) std::memcpy(to, bytes_.data() + at_, n);
    at_ += n;
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
};

GmshBlock block_of(Reader& reader) {
  GmshBlock block;
  block.dimension = static_cast<int>(reader.number());
  block.shape = reader.text();
  block.nodes_each = static_cast<int>(reader.number());
  block.tags = reader.numbers<std::size_t>();
  block.nodes = reader.numbers<std::size_t>();
  block.groups = reader.texts();
  require(!block.tags.empty() && block.nodes_each >= (block.dimension == 1 ? 2 : 1));
  require(block.nodes.size() == block.tags.size() * static_cast<std::size_t>(block.nodes_each));
  return block;
}

}  // namespace

std::string bytes_of(const GmshFile& file) {
  Writer writer;
  writer.add_numbers(file.node_tags);
  writer.add_numbers(file.positions);
  writer.add(file.blocks.size());
  for (const GmshBlock& block : file.blocks) {
    writer.add(static_cast<std::size_t>(block.dimension));
    writer.add(block.shape);
    writer.add(static_cast<std::size_t>(block.nodes_each));
    writer.add_numbers(block.tags);
    writer.add_numbers(block.nodes);
    writer.add(block.groups);
  }
  for (const std::vector<std::string>& names : file.groups) writer.add(names);
  return std::move(writer).bytes();
}

GmshFile gmsh_file_of(const std::string& bytes) {
  Reader reader(bytes);
  GmshFile file;
  file.node_tags = reader.numbers<std::size_t>();
  file.positions = reader.numbers<double>();
  require(file.positions.size() == 3 * file.node_tags.size());
  for (std::size_t left = reader.number(); left > 0; --left) file.blocks.push_back(block_of(reader));
  for (std::vector<std::string>& names : file.groups) names = reader.texts();
  require(reader.is_at_end());
  return file;
}

}  // namespace voussoir::fem
