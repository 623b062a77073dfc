// As much of JSON as the protocol needs. Numbers and strings stay as they are written: an id comes back as it was.
#pragma once
#include <cctype>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace json {

enum class Kind { null, boolean, number, string, array, object };

struct Value {
    Kind kind = Kind::null;
    std::string text;  // of a number or a boolean as it is written, of a string what is written between its quotes
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
        if (kind != Kind::number) throw std::runtime_error("a whole number is needed");
        return std::stoll(text);
    }
    bool operator==(const Value& other) const { return kind == other.kind && text == other.text; }
};

inline Value number(long long value) { return {Kind::number, std::to_string(value), {}, {}}; }
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
        switch (peek()) {
            case '{': return read_object(depth);
            case '[': return read_array(depth);
            case '"': return string(read_string());
            case 't': expect("true"); return {Kind::boolean, "true", {}, {}};
            case 'f': expect("false"); return {Kind::boolean, "false", {}, {}};
            case 'n': expect("null"); return {};
            default: return read_number();
        }
    }

    Value read_number() {
        std::size_t begin = at_;
        while (std::isalnum(static_cast<unsigned char>(peek())) || peek() == '-' || peek() == '+' || peek() == '.') ++at_;
        if (begin == at_) throw std::runtime_error("this is no JSON");
        return {Kind::number, text_.substr(begin, at_ - begin), {}, {}};
    }

    Value read_array(int depth) {
        Value value{Kind::array, "", {}, {}};
        expect("[");
        skip_space();
        while (peek() != ']') {
            value.items.push_back(read(depth + 1));
            skip_space();
            if (peek() != ']') expect(",");
        }
        expect("]");
        return value;
    }

    Value read_object(int depth) {
        Value value{Kind::object, "", {}, {}};
        expect("{");
        skip_space();
        while (peek() != '}') {
            skip_space();
            std::string name = read_string();
            skip_space();
            expect(":");
            value.fields.emplace_back(std::move(name), read(depth + 1));
            skip_space();
            if (peek() != '}') expect(",");
        }
        expect("}");
        return value;
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
    switch (value.kind) {
        case Kind::null: out += "null"; break;
        case Kind::boolean:
        case Kind::number: out += value.text; break;
        case Kind::string: out += '"' + value.text + '"'; break;
        case Kind::array:
            out += '[';
            for (std::size_t i = 0; i < value.items.size(); ++i) {
                if (i > 0) out += ',';
                write(value.items[i], out);
            }
            out += ']';
            break;
        case Kind::object:
            out += '{';
            for (std::size_t i = 0; i < value.fields.size(); ++i) {
                if (i > 0) out += ',';
                out += '"' + value.fields[i].first + "\":";
                write(value.fields[i].second, out);
            }
            out += '}';
            break;
    }
}

}  // namespace json
