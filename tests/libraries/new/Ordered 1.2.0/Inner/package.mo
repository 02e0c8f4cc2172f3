within Ordered;
package Inner
end Inner;
