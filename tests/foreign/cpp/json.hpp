// As much of JSON as the protocol needs. Numbers and strings stay as they are written: an id comes back as it was.
#pragma once
#include <cctype>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace json {

enum class Kind { plain, string, array, object };  // a number, true, false and null are plain

struct Value {
    Kind kind = Kind::plain;
    std::string text = "null";  // as it is written, of a string between its quotes
    std::vector<Value> items;
    std::vector<std::pair<std::string, Value>> fields;

    const Value* find(const std::string& name) const {
        for (const auto& [key, value] : fields)
            if (key == name) return &value;
        return nullptr;
    }
    const Value& at(const std::string& name) const {
        if (const Value* value = find(name)) return *value;
        throw std::runtime_error("the field " + name + " must be there");
    }
    long long integer() const {
        if (kind != Kind::plain || text.find_first_not_of("-0123456789") != std::string::npos)
            throw std::runtime_error("a whole number is needed");
        return std::stoll(text);
    }
    bool operator==(const Value& other) const { return kind == other.kind && text == other.text; }
};

inline Value number(long long value) { return {Kind::plain, std::to_string(value), {}, {}}; }
inline Value string(std::string text) { return {Kind::string, std::move(text), {}, {}}; }
inline Value array(std::vector<Value> items) { return {Kind::array, "", std::move(items), {}}; }
inline Value object(std::vector<std::pair<std::string, Value>> fields) {
    return {Kind::object, "", {}, std::move(fields)};
}

class Reader {
  public:
    explicit Reader(const std::string& text) : text_(text) {}

    Value read_all() {
        Value value = read(0);
        skip_space();
        if (at_ != text_.size()) throw std::runtime_error("there is more than one value");
        return value;
    }

  private:
    const std::string& text_;
    std::size_t at_ = 0;

    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    void skip_space() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    }
    void expect(const std::string& word) {
        if (text_.compare(at_, word.size(), word) != 0) throw std::runtime_error("this is no JSON");
        at_ += word.size();
    }

    Value read(int depth) {
        if (depth > 200) throw std::runtime_error("this is nested too deep");
        skip_space();
        Value value;
        if (peek() == '[') {
            value.kind = Kind::array;
            read_entries(']', [&] { value.items.push_back(read(depth + 1)); });
        } else if (peek() == '{') {
            value.kind = Kind::object;
            read_entries('}', [&] {
                skip_space();
                std::string name = read_string();
                skip_space();
                expect(":");
                value.fields.emplace_back(std::move(name), read(depth + 1));
            });
        } else if (peek() == '"') {
            value = string(read_string());
        } else {
            value.text = read_plain();
        }
        return value;
    }

    template <typename Read>
    void read_entries(char end, Read read_entry) {
        ++at_;
        skip_space();
        while (peek() != end) {
            read_entry();
            skip_space();
            if (peek() != end) expect(",");
        }
        ++at_;
    }

    std::string read_plain() {
        std::size_t begin = at_;
        while (std::isalnum(static_cast<unsigned char>(peek())) || peek() == '-' || peek() == '+' || peek() == '.') ++at_;
        if (begin == at_) throw std::runtime_error("this is no JSON");
        return text_.substr(begin, at_ - begin);
    }

    std::string read_string() {
        expect("\"");
        const std::size_t begin = at_;
        while (peek() != '"') {
            at_ += peek() == '\\' ? 2 : 1;
            if (at_ >= text_.size()) throw std::runtime_error("a string has no end");
        }
        return text_.substr(begin, at_++ - begin);
    }
};

inline void write(const Value& value, std::string& out) {
    const char* between = "";
    switch (value.kind) {
        case Kind::plain: out += value.text; break;
        case Kind::string: out += '"' + value.text + '"'; break;
        case Kind::array:
            out += '[';
            for (const Value& item : value.items) {
                out += between;
                write(item, out);
                between = ",";
            }
            out += ']';
            break;
        case Kind::object:
            out += '{';
            for (const auto& [name, field] : value.fields) {
                out += between + ('"' + name + "\":");
                write(field, out);
                between = ",";
            }
            out += '}';
            break;
    }
}

}  // namespace json
