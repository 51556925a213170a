// Parses scene files into Node trees: one handler of yaml-cpp's events, and the caps that keep hostile files harmless.
#include "sim/files/document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sim/error.hpp"

namespace understory {
namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw Error(ErrorKind::invalid_input, where + ": " + what);
}

/// Builds the tree from the parser's events. Tags are refused; aliases share the node of their anchor.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const Document& document, std::uint32_t source) : document_(document), source_(source) {}
  std::shared_ptr<Node> root;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(make(mark, Node::Kind::null, anchor)); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override {
    refuse_tag(mark, tag);
    auto node = make(mark, Node::Kind::scalar, anchor);
    node->text = text;
    node->quoted = tag == "!";  // yaml-cpp: "!" for quoted scalars, "?" for plain ones
    add(std::move(node));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end() || is_open(*found->second)) refuse_at(mark, "this alias stands for itself");
    add(found->second, place(mark));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, Node::Kind::list, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, Node::Kind::map, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    std::shared_ptr<Node> node;
    bool expects_key = false;
  };

  Place place(const YAML::Mark& mark) const {
    return {source_, static_cast<std::uint32_t>(mark.line + 1), static_cast<std::uint32_t>(mark.column + 1)};
  }
  [[noreturn]] void refuse_at(const YAML::Mark& mark, const std::string& what) const {
    refuse(document_.describe(place(mark)), what);
  }
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (tag != "?" && tag != "!" && !tag.empty()) refuse_at(mark, fmt::format("tag '{}': tags are not allowed", tag));
  }
  bool is_open(const Node& node) const {
    return std::any_of(open_.begin(), open_.end(), [&](const Open& o) { return o.node.get() == &node; });
  }
  std::shared_ptr<Node> make(const YAML::Mark& mark, Node::Kind kind, YAML::anchor_t anchor) {
    auto node = std::make_shared<Node>();
    node->kind = kind;
    node->place = place(mark);
    if (anchor) anchors_[anchor] = node;
    return node;
  }
  void open(const YAML::Mark& mark, const std::string& tag, Node::Kind kind, YAML::anchor_t anchor) {
    refuse_tag(mark, tag);
    if (open_.size() >= deepest_scene_nesting) {
      refuse_at(mark, fmt::format("nested too deeply: at most {} levels are allowed", deepest_scene_nesting));
    }
    open_.push_back({make(mark, kind, anchor), kind == Node::Kind::map});
  }
  void close() {
    const std::shared_ptr<Node> node = open_.back().node;
    open_.pop_back();
    add(node);
  }
  void add(const std::shared_ptr<Node>& node) { add(node, node->place); }

  /// Puts a finished node where the parser stands: as the root, a list item, a map's key or its value.
  void add(const std::shared_ptr<Node>& node, const Place& at) {
    if (open_.empty()) {
      root = node;
      return;
    }
    Open& parent = open_.back();
    if (parent.expects_key) {
      if (node->kind != Node::Kind::scalar) refuse(document_.describe(at), "a key must be plain text");
      parent.node->keys.push_back({node->text, at});
      parent.expects_key = false;
      return;
    }
    parent.expects_key = parent.node->kind == Node::Kind::map;
    parent.node->items.push_back(node);
    parent.node->nodes += node->nodes;
    if (parent.node->nodes > largest_scene_nodes) {
      refuse(document_.describe(at),
             fmt::format("more than {} values, aliases written out: no more are allowed", largest_scene_nodes));
    }
  }

  const Document& document_;
  std::uint32_t source_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, std::shared_ptr<Node>> anchors_;
};

/// Parses one YAML document; an empty text gives null.
std::shared_ptr<Node> parse_yaml(const Document& document, std::uint32_t source, const std::string& text) {
  std::istringstream stream(text);
  TreeBuilder builder(document, source);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    TreeBuilder second(document, source);
    if (parser.HandleNextDocument(second)) refuse(document.sources[source], "holds two documents: one is allowed");
  } catch (const YAML::Exception& error) {
    const Place place{source, static_cast<std::uint32_t>(error.mark.line + 1),
                      static_cast<std::uint32_t>(error.mark.column + 1)};
    refuse(document.describe(place), "not valid YAML: " + error.msg);
  }
  return builder.root ? builder.root : std::make_shared<Node>();
}

std::string read_text(const std::filesystem::path& file) {
  std::error_code failure;
  if (!std::filesystem::exists(file, failure)) refuse(file.string(), "there is no such file");
  if (!std::filesystem::is_regular_file(file, failure)) refuse(file.string(), "not a file");
  const std::uintmax_t bytes = std::filesystem::file_size(file, failure);
  if (failure) throw Error(ErrorKind::input_output, file.string() + ": cannot be read: " + failure.message());
  if (bytes > largest_scene_bytes) {
    refuse(file.string(), fmt::format("{} bytes: a scene file may have {} at most", bytes, largest_scene_bytes));
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(bytes, '\0');
  if (!stream.read(text.data(), static_cast<std::streamsize>(bytes))) {
    throw Error(ErrorKind::input_output, file.string() + ": cannot be read");
  }
  const auto control = std::find_if(text.begin(), text.end(), [](unsigned char c) {
    return (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7f;
  });
  if (control != text.end()) {
    const auto line = 1 + std::count(text.begin(), control, '\n');
    refuse(fmt::format("{}:{}", file.string(), line),
           fmt::format("byte {:#04x}: a scene file must be text in UTF-8", static_cast<unsigned char>(*control)));
  }
  return text;
}

/// JSON is a subset of YAML but for tabs, which valid JSON only has between values: checked first, then blanked.
void check_json(const std::string& file, std::string& text) {
  try {
    [[maybe_unused]] const nlohmann::json syntax_only = nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const std::string before = text.substr(0, error.byte ? error.byte - 1 : 0);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t column = before.size() - (before.find_last_of('\n') + 1) + 1;  // npos + 1 is 0: the first line
    refuse(fmt::format("{}:{}:{}", file, line, column), fmt::format("not valid JSON: {}", error.what()));
  } catch (const nlohmann::json::out_of_range&) {
    // A number beyond double: the decoder refuses it with its key.
  }
  std::replace(text.begin(), text.end(), '\t', ' ');
}

/// The child that one step of a dotted path names, made if it is a new key or the next item; null: no such place.
std::shared_ptr<Node>* child(Node& parent, const std::string& step, const Place& place) {
  if (parent.kind == Node::Kind::null) parent.kind = Node::Kind::map;
  if (parent.kind == Node::Kind::map) {
    for (std::size_t i = 0; i < parent.keys.size(); ++i) {
      if (parent.keys[i].name == step) return &parent.items[i];
    }
    parent.keys.push_back({step, place});
  } else {
    std::size_t index = 0;
    const auto parsed = std::from_chars(step.data(), step.data() + step.size(), index);
    if (parent.kind != Node::Kind::list || parsed.ec != std::errc() || *parsed.ptr || index > parent.items.size()) {
      return nullptr;
    }
    if (index < parent.items.size()) return &parent.items[index];
  }
  parent.items.push_back(std::make_shared<Node>());
  parent.items.back()->place = place;
  return &parent.items.back();
}

void remove_child(Node& parent, const std::shared_ptr<Node>& value) {
  const auto at = std::find(parent.items.begin(), parent.items.end(), value) - parent.items.begin();
  parent.items.erase(parent.items.begin() + at);
  if (parent.kind == Node::Kind::map) parent.keys.erase(parent.keys.begin() + at);
}

}  // namespace

const Node* Node::find(const std::string& name) const {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].name == name) return items[i].get();
  }
  return nullptr;
}

std::string Document::describe(const Place& place) const {
  const std::string& source = sources[place.source];
  return place.source == 0 && place.line > 0 ? fmt::format("{}:{}:{}", source, place.line, place.column) : source;
}

Document read_document(const std::filesystem::path& file) {
  Document document;
  document.sources.push_back(file.string());
  std::string text = read_text(file);
  if (file.extension() == ".json") check_json(file.string(), text);
  document.root = parse_yaml(document, 0, text);
  return document;
}

void apply_override(Document& document, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string where = fmt::format("--set {}", assignment);
  if (equals == std::string::npos || equals == 0) refuse(where, "allowed is KEY=VALUE, as in wind.speed=4.2");
  if (equals + 1 == assignment.size()) refuse(where, "no value; `null` takes the key out");
  const auto source = static_cast<std::uint32_t>(document.sources.size());
  document.sources.push_back(where);
  const std::shared_ptr<Node> value = parse_yaml(document, source, assignment.substr(equals + 1));
  const Place place{source, 0, 0};

  std::shared_ptr<Node>* target = &document.root;
  Node* parent = nullptr;
  std::istringstream path(assignment.substr(0, equals));
  for (std::string step; std::getline(path, step, '.');) {
    if ((*target).use_count() > 1) *target = std::make_shared<Node>(**target);  // an alias: change this one only
    parent = target->get();
    target = child(*parent, step, place);
    if (!target) {
      refuse(where, parent->kind == Node::Kind::list
                        ? fmt::format("'{}': allowed is a list position from 0 to {}", step, parent->items.size())
                        : fmt::format("'{}': there are no keys below the value '{}'", step, parent->text));
    }
  }
  *target = value;
  if (value->kind == Node::Kind::null) remove_child(*parent, value);
}

}  // namespace understory
